"""What loads, drives and stresses a linkage, as stated in files."""
