"""
Map the asymmetry of a face
===========================

Text
"""

import symsurf
