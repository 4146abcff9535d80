"""Landmarks and cohorts, by geometric morphometrics.

>>> paired = symsurf.landmark_pairs(landmarks.points, mirror, landmarks.names)
>>> symsurf.cohort(individuals, paired.pairs).table["side"]
"""

from .carrying import carry_landmarks
from .cohorts import AnovaRow, Cohort, cohort
from .pairing import LandmarkPairs, landmark_pairs
from .planes import plane_of_landmarks

__all__ = [
    "AnovaRow",
    "Cohort",
    "LandmarkPairs",
    "carry_landmarks",
    "cohort",
    "landmark_pairs",
    "plane_of_landmarks",
]
