"""How the loop of each kind of linkage closes: all that differs between kinds, a file each."""
