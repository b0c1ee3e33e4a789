"""The command `drystone`, on top of the library."""
