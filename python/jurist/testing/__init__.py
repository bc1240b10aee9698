"""For tests of this package and of others."""
