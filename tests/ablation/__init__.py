"""What each mechanism of the core is worth: the accuracy with and without it, by ``make ablation``.

``mechanisms.toml`` lists them. A copy of the sources asks ``without("NAME")`` where each is, so that
one build measures them all.
"""
