"""
Measure many files at once
==========================

A folder of scans, and a table with a row for each. A file that is broken has its reason in the table;
the others are done all the same.
"""

from pathlib import Path
from tempfile import mkdtemp

import matplotlib.pyplot as plt
import numpy as np
import shapes

import symsurf

folder = Path(mkdtemp())
for number, depth in enumerate(np.linspace(0, 0.1, 6)):
    hurt = shapes.dented(shapes.head(5), at=(0.45, -0.55, -0.15), width=0.3, depth=depth)
    hurt.to_pyvista().save(folder / f"scan{number}.ply")
(folder / "scan6.ply").write_text("not a scan")

# %%
# ``batch`` gives one dictionary per file, as they come; with ``jobs=4`` four files are in work at once.
# ``pandas.DataFrame(rows)`` is the table.

rows = list(symsurf.batch(sorted(folder.glob("*.ply")), "asymmetry"))
for row in rows:
    print(
        Path(row["file"]).name,
        row["error"].split(": ")[-1] or f"rms {row['rms']:.4f}, 95 % {row['p95']:.4f}",
    )

# %%
# One of them against all:

done = [row for row in rows if not row["error"]]
figure, axes = plt.subplots(figsize=(6.4, 3))
axes.bar([Path(row["file"]).stem for row in done], [row["rms"] for row in done], color="#7fb2ee")
axes.set_ylabel("rms asymmetry")
figure.tight_layout()
figure.savefig("table.png", dpi=110)

# %%
# The same from a shell, with a report that turns in 3D: ::
#
#     symsurf asymmetry scans --jobs 4 --table asymmetry.csv
#     symsurf report scans --output report.html
#
# :doc:`/command_line` has every column of the table, :doc:`many_files` what goes on after a crash.
