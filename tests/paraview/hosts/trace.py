"""Records a trace, replays it, and tells the mirror's field data before and after."""

import os
import sys

from paraview import simple, smtrace
from session import answer, fetched, field

smtrace.start_trace()
cone = simple.Cone(Resolution=24)
detection = simple.MirrorDetection(Input=cone, Method="plane", PlanePairDistance=0.125)
detection.UpdatePipeline()
text = smtrace.stop_trace()
before = field(fetched(detection, 1))
with open(os.path.join(sys.argv[2], "trace_made.py"), "w") as file:
    file.write(text)

simple.Delete(detection)
simple.Delete(cone)
exec(compile(text, "trace_made.py", "exec"))  # noqa: S102 (to replay it is the test)
replayed = [p for (name, _), p in simple.GetSources().items() if name.startswith("MirrorDetection")]
assert len(replayed) == 1
answer([before, field(fetched(replayed[0], 1))])
