"""Where a linkage meets its targets: driver angles and assemblies, one by one or in order."""
