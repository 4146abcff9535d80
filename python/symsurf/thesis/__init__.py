"""The thesis's experiments, made anew, beside the numbers that it prints."""
