"""What knows no shapes: descriptions in words, optional packages, processes, plain values."""
