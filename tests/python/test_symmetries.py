"""The symmetries of parts against what they are made to have."""

from __future__ import annotations

import json
from itertools import product

import numpy as np
import pytest
from command_line import run
from numpy.typing import NDArray
from symmetric_parts import PARTS, cut, noisy
from symmetric_shapes import random_rotation

import symsurf

Array = NDArray[np.float64]
COUNT = 10_000
SEED = 0
