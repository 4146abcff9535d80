"""The tables of bad input, and properties out of range, in one session: what each filter said, how
many points it left, and how many a good run after it finds.

Arguments: the answer file, [[property, method, value], ...] as JSON.
"""

import json
import sys

from bad_tables_data import CLOUDS, GOOD, MIRRORS, cloud_of, mirror_of, run
from paraview import simple
from session import answer


def detect(data, **properties):
    return run(lambda source: simple.MirrorDetection(Input=source), data, **properties)


def reflect(data, mirror):
    return run(lambda a, b: simple.MirrorReflection(Input=a, Mirror=b), data, mirror)


good = cloud_of(GOOD)
plane = mirror_of("plane", {"normal": (1.0, 0.0, 0.0), "offset": 0.0})
answers = {"clouds": [], "mirrors": [], "properties": []}


def case(kind, seen, again):
    answers[kind].append(seen | {"good": again["points"], "said of good": again["said"]})


for cloud in CLOUDS:
    seen = detect(cloud_of(cloud.points), Method="plane", RefuseNonfinite=cloud.refuses_nonfinite)
    case("clouds", seen, detect(good, Method="plane"))
for mirror in MIRRORS:
    case("mirrors", reflect(good, mirror_of(mirror.kind, mirror.numbers)), reflect(good, plane))
for name, method, value in json.loads(sys.argv[2]):
    seen = detect(good, Method=method, **{name: float("nan") if value is None else value})
    case("properties", seen, detect(good, Method="plane"))
answer(answers)
