"""How accurate the methods are: every figure of the documentation, made again by ``make accuracy``.

Each case draws its shapes, poses and damage from the seed; nothing is chosen by hand.
"""
