"""Bad input that every front end must refuse; README.md describes the tables."""
