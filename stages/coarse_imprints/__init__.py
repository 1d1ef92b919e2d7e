"""Why frozen filters are at chance on a 16 x 16 array in T table 5.3."""
