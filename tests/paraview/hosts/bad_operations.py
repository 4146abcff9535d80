"""The tables of bad input, properties out of range and masks that are none, for the operations in one
session: what each filter said and how many points it left. One code reads mirrors and clouds for all of
them: each row of a table is for one.

Arguments: the answer file, [proxy, ...] and [[proxy, property, value], ...] as JSON.
"""

import json
import sys

from bad_tables_data import CLOUDS, GOOD, MIRRORS, cloud_of, mirror_of, run
from paraview import simple
from session import answer

PROXIES = json.loads(sys.argv[2])
good, plane = cloud_of(GOOD), mirror_of("plane", {"normal": (1.0, 0.0, 0.0), "offset": 0.0})


def operate(name, *inputs, **properties):
    make = getattr(simple, name)
    ports = ("Input", "Mirror")
    return run(lambda *sources: make(**dict(zip(ports, sources))), *inputs, **properties)


def own_rows(table, proxy):
    return table[PROXIES.index(proxy) :: len(PROXIES)]


answers = {
    "mirrors": {
        name: [
            operate(name, good, mirror_of(row.kind, row.numbers)) for row in own_rows(MIRRORS, name)
        ]
        for name in PROXIES
    },
    "clouds": {
        name: [
            operate(name, cloud_of(row.points), Method="plane") for row in own_rows(CLOUDS, name)
        ]
        for name in PROXIES
    },
    "properties": [],
    "masks": {},
    "good": {name: operate(name, good, plane) for name in PROXIES},
}
for name, setting, value in json.loads(sys.argv[3]):
    number = float("nan") if value is None else value
    answers["properties"].append(operate(name, good, plane, **{setting: number}))
for mask, reason in {"None": "", "": "", "Nothing": "MaskArray is 'Nothing'"}.items():
    said = operate("MirrorSymmetrization", good, plane, MaskArray=mask)
    answers["masks"][mask] = (said, reason)
answer(answers)
