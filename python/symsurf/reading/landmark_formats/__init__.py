"""The formats of landmarks: each module has a function that gives those of every specimen."""
