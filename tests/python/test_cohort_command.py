"""symsurf cohort: what it reads, writes and refuses."""

from __future__ import annotations

import csv
import json
import re

import numpy as np
import pytest
from cohort_samples import COUNT, PAIRS, ROWS, moved, sample
from command_line import run_here
from symmetric_shapes import mirrored_surface, random_rotation

import symsurf
from symsurf.morphometrics.specimens import Specimens, paired


def write_landmarks(folder, landmarks, names):
    files = []
    for i, each in enumerate(landmarks.reshape(-1, COUNT, 3)):
        order = np.random.default_rng(i).permutation(COUNT)  # names tell which is which
        lines = [f"{names[k]},{','.join(map(repr, each[k].tolist()))}" for k in order]
        files.append(f"skull_{i}.csv")
        (folder / files[-1]).write_text("name,x,y,z\n" + "\n".join(lines) + "\n")
    return " ".join(files)


NAMES = [f"{side}_{stem}" for side in "lr" for stem in "abcdef"] + ["n1", "n2", "n3"]
PLAIN = [f"point{i}" for i in range(COUNT)]


def rows_of(path):
    with path.open() as file:
        return list(csv.DictReader(file))


def check_table(path, table):
    for row, name in zip(rows_of(path), ROWS, strict=True):
        assert row["source"] == name
        for key, value in table[name].items():
            assert (row[key] == "") if np.isnan(value) else float(row[key]) == pytest.approx(value)


def test_command_line(rng, tmp_path):
    landmarks = sample(rng, da=0.05, fa=0.05, me=0.02)
    files = write_landmarks(tmp_path, landmarks, NAMES)
    options = (
        "--replicates 2 --permutations 99 --seed 3 --table out/anova.csv --individuals out/i.csv"
    )
    done = run_here(f"cohort {files} {options}", tmp_path)
    assert done.returncode == 0, done.stderr
    expected = symsurf.cohort(landmarks, PAIRS, permutations=99, seed=3)
    check_table(tmp_path / "out/anova.csv", expected.table)
    assert "individual x side" in done.stdout and "6, 3 on the midline, by names" in done.stdout
    rows = rows_of(tmp_path / "out/i.csv")
    assert [row["individual"] for row in rows] == [f"skull_{2 * i}" for i in range(8)]
    lengths = np.linalg.norm(expected.asymmetric, axis=(1, 2))
    np.testing.assert_allclose([float(row["asymmetry"]) for row in rows], lengths)


def test_replicates_that_are_none_are_told(rng, tmp_path):
    """Nothing of those one behind the other, all of those that are apart."""
    write_landmarks(tmp_path, sample(rng, n=4, fa=0.05, me=0.01), NAMES)
    for order, told in (
        ([0, 1, 2, 3, 4, 5, 6, 7], ""),
        ([0, 2, 4, 6, 1, 3, 5, 7], "8 of 8 specimens"),
    ):
        files = " ".join(f"skull_{i}.csv" for i in order)
        done = run_here(f"cohort {files} --replicates 2 --permutations 0", tmp_path)
        assert done.returncode == 0 and told in done.stderr and bool(told) == bool(done.stderr)
        assert ("as skull_0 to skull_1" in done.stderr) == bool(told)


@pytest.mark.parametrize("names", [NAMES, PLAIN])
def test_command_line_with_pairs(names, rng, tmp_path):
    landmarks = sample(rng, fa=0.05, me=0.02)
    files = write_landmarks(tmp_path, landmarks, names)
    by_name = "".join(f"{names[a]}, {names[b]}\n" for a, b in PAIRS)
    (tmp_path / "pairs.csv").write_text("# left, right\n" + by_name)
    line = f"cohort {files} --pairs pairs.csv --permutations 9 --replicates 2 --table a.csv --json"
    done = run_here(line, tmp_path)
    assert done.returncode == 0, done.stderr
    expected = symsurf.cohort(landmarks, PAIRS, permutations=9).table
    check_table(tmp_path / "a.csv", expected)
    record = json.loads(done.stdout)
    assert record["table"]["side"]["ss"] == pytest.approx(expected["side"]["ss"])
    assert record["table"]["error"]["F"] is None and record["pairs_from"] == "pairs.csv"


def test_command_line_of_one_tps(rng, tmp_path):
    landmarks = sample(rng, fa=0.05, me=0.02, d=2)
    texts = [
        "LM=15\n" + "\n".join(f"{x!r} {y!r}" for x, y in each.tolist()) + f"\nID={i}\nSCALE=0.5\n"
        for i, each in enumerate(landmarks.reshape(-1, COUNT, 2))
    ]
    (tmp_path / "all.tps").write_text("\n".join(texts))
    (tmp_path / "pairs.csv").write_text("\n".join(f"{a},{b}" for a, b in PAIRS))
    line = "cohort all.tps --pairs pairs.csv --replicates 2 --table a.csv --permutations 9"
    done = run_here(line, tmp_path)
    assert done.returncode == 0, done.stderr
    check_table(tmp_path / "a.csv", symsurf.cohort(landmarks, PAIRS, permutations=9).table)


def test_no_specimen_becomes_a_formula(rng, tmp_path):
    """The name of a specimen is what its file says, and a spreadsheet may open the table."""
    texts = [
        "LM=15\n" + "\n".join(f"{x!r} {y!r}" for x, y in each.tolist()) + f"\nID={name}\n"
        for each, name in zip(sample(rng, fa=0.05, d=2)[:, 0], ["=1+1", "@a", "-b", "c"])
    ]
    (tmp_path / "all.tps").write_text("".join(texts))
    (tmp_path / "pairs.csv").write_text("\n".join(f"{a},{b}" for a, b in PAIRS))
    line = "cohort all.tps --pairs pairs.csv --individuals i.csv --permutations 9"
    assert run_here(line, tmp_path).returncode == 0
    names = [row["individual"] for row in rows_of(tmp_path / "i.csv")]
    assert names == ["'=1+1", "'@a", "'-b", "c"]


def test_command_line_finds_pairs_by_the_mirror(rng, tmp_path):
    """Where no names tell: over the plane of the mean."""
    points, plane = mirrored_surface(30, 3)
    pairs = symsurf.landmark_pairs(points, plane)
    assert len(pairs.pairs) == 15
    made = points + 0.01 * rng.normal(size=(6, 1, *points.shape))
    texts = [
        f"LM3={len(points)}\n" + "\n".join(" ".join(map(repr, row)) for row in each.tolist()) + "\n"
        for each in moved(made, rng)[:, 0]
    ]
    (tmp_path / "all.tps").write_text("\n".join(texts))
    done = run_here("cohort all.tps --table a.csv --permutations 9", tmp_path)
    assert done.returncode == 0, done.stderr
    assert "15, 0 on the midline, by the mirror found" in done.stdout
    check_table(tmp_path / "a.csv", symsurf.cohort(made, pairs, permutations=9).table)


def ball(turn=None, nsub=3):
    """A lumpy one, mirrored over x = 0; turned, its triangulation is not."""
    pyvista = pytest.importorskip("pyvista")
    sphere = pyvista.Icosphere(radius=1, nsub=nsub)
    x = np.asarray(sphere.points, dtype=float) @ (np.eye(3) if turn is None else turn)
    lumps = [
        (0.9, 0.1, 0.4),
        (0.5, -0.8, 0.3),
        (0.4, 0.5, -0.8),
        (0.3, 0.4, 0.9),
        (0.7, -0.5, -0.5),
    ]
    radius = 1 + 0.2 * np.sin(2 * x[:, 1] + 1) + 0.1 * x[:, 2] ** 3
    for lump in np.concatenate([lumps, np.array(lumps) * (-1, 1, 1)]):
        radius += 0.2 * np.exp(-((x - lump) ** 2).sum(axis=1) / 0.06)
    return x * radius[:, None] * (1, 1.3, 0.8), sphere.regular_faces


def bent_more_and_more(x, count=5):
    """(count, k, 3), of which one side is bent."""
    right = np.maximum(x[:, :1], 0)
    shapes = [
        x * (1 + 0.02 * i * np.array([0, 1, 0.5])) + 0.01 * i * right * (0, 1, 0)
        for i in range(count)
    ]
    return np.array(shapes)


def partners(x):
    return np.array([np.linalg.norm(x - row * (-1, 1, 1), axis=1).argmin() for row in x])


def write_mesh(path, points, faces):
    lines = ["OFF", f"{len(points)} {len(faces)} 0"]
    lines += [" ".join(map(repr, row)) for row in points.tolist()]
    lines += [f"3 {a} {b} {c}" for a, b, c in faces.tolist()]
    path.write_text("\n".join(lines) + "\n")


def test_command_line_of_meshes(tmp_path):
    x, faces = ball()
    shapes = bent_more_and_more(x)
    for i, shape in enumerate(shapes):
        write_mesh(tmp_path / f"m{i}.off", shape, faces)
    pairs = [(a, b) for a, b in enumerate(partners(x)) if a < b]
    (tmp_path / "pairs.csv").write_text("\n".join(f"{a},{b}" for a, b in pairs))
    files = " ".join(f"m{i}.off" for i in range(5))
    expected = symsurf.cohort(shapes, pairs, permutations=9).table
    for options in ("--pairs pairs.csv", ""):
        done = run_here(f"cohort {files} {options} --table a.csv --permutations 9", tmp_path)
        assert done.returncode == 0, done.stderr
        assert f"{len(pairs)}, {len(x) - 2 * len(pairs)} on the midline" in done.stdout
        check_table(tmp_path / "a.csv", expected)


def test_meshes_whose_triangulation_is_not_symmetric(rng, tmp_path):
    """Compared are the points of the surface that mirror each other, as of known ones, but for the
    error of homologous points, which is the same for all individuals and is said to be in the row side."""
    x, faces = ball(random_rotation(rng), nsub=4)
    for i, shape in enumerate(bent_more_and_more(x)):
        write_mesh(tmp_path / f"m{i}.off", shape, faces)
    files = " ".join(f"m{i}.off" for i in range(5))
    done = run_here(f"cohort {files} --permutations 0 --json", tmp_path)
    assert done.returncode == 0, done.stderr
    record = json.loads(done.stdout)
    right = x[x[:, 0] > 0]
    assert record["pairs"] == pytest.approx(len(right), rel=0.1)
    known = bent_more_and_more(np.concatenate([right, right * (-1, 1, 1)]))
    pairs = np.arange(2 * len(right)).reshape(2, -1).T
    expected = symsurf.cohort(known, pairs, permutations=0).table
    found = {name: row["ss"] for name, row in record["table"].items()}
    assert found["individual"] == pytest.approx(expected["individual"]["ss"], rel=0.03)
    assert found["individual_side"] == pytest.approx(expected["individual_side"]["ss"], rel=0.15)
    assert "directional asymmetry has the error of homologous points" in record["pairs_from"]


def test_pairs_of_a_triangulation():
    """Of each vertex the one that mirrors it; where one edge is another, homologous points."""
    x, faces = ball()
    shapes = bent_more_and_more(x)
    partner = partners(x)
    _, found, source = paired(Specimens(list("abcde"), shapes, faces=faces))
    both = np.column_stack([np.arange(len(x)), partner])
    np.testing.assert_array_equal(found.pairs, both[both[:, 0] < both[:, 1]])
    np.testing.assert_array_equal(found.midline, np.flatnonzero(partner == np.arange(len(x))))
    assert "triangulation is not symmetric" not in source
    a, b, c = faces[0]
    (other,) = (i for i, face in enumerate(faces) if i and {a, b} <= set(face))
    (d,) = set(faces[other]) - {a, b}
    flipped = faces.copy()
    flipped[0], flipped[other] = (a, d, c), (d, b, c)
    assert "not symmetric" in paired(Specimens(list("abcde"), shapes, faces=flipped))[2]


def cells(page):
    """The rows of all tables, without their tags."""
    rows = re.findall("<tr>(.*?)</tr>", page)
    return [re.findall("<td[^>]*>(.*?)</td>", row) for row in rows]


def test_report_of_landmarks(rng, tmp_path):
    """A row a landmark: mean and deviation of the asymmetry, an individual's, and its percentile."""
    pytest.importorskip("trame_vtk")
    landmarks = sample(rng, da=0.05, fa=0.05, me=0.02)
    files = write_landmarks(tmp_path, landmarks, NAMES)
    found = symsurf.cohort(landmarks, PAIRS, permutations=9)
    lengths = np.linalg.norm(found.asymmetric, axis=2)
    most = int((lengths**2).sum(axis=1).argmax())
    other = (most + 1) % 8
    for options, shown in (("", most), (f"--compare skull_{2 * other}", other)):
        line = f"cohort {files} --replicates 2 --permutations 9 --report page.html {options}"
        done = run_here(line, tmp_path)
        assert done.returncode == 0, done.stderr
        page = (tmp_path / "page.html").read_text()
        assert f"skull_{2 * shown} against the others" in page and "<iframe" not in page
        rows = {row[0]: row[1:] for row in cells(page) if row}
        assert "individuals x sides: fluctuating asymmetry" in rows
        first = rows["skull_0"]  # of the table of individuals
        assert float(first[0]) == pytest.approx(found.size[0].mean(), rel=1e-3)
        size = found.size.mean()
        for k, name in enumerate(NAMES):
            own, vectors = lengths[:, k], found.asymmetric[:, k]
            mean = np.linalg.norm(vectors.mean(axis=0))
            deviation = np.sqrt(((vectors - vectors.mean(axis=0)) ** 2).sum() / 7)
            percentile = 100 * (own < own[shown]).sum() / 7
            expected = [size * mean, size * deviation, size * own[shown], percentile]
            assert [float(cell) for cell in rows[name]] == pytest.approx(expected, rel=1e-3)


def test_report_of_meshes(tmp_path):
    """In 3D: mean, deviation, and an individual."""
    pytest.importorskip("trame_vtk")
    x, faces = ball()
    for i, shape in enumerate(bent_more_and_more(x)):
        write_mesh(tmp_path / f"m{i}.off", shape, faces)
    files = " ".join(f"m{i}.off" for i in range(5))
    done = run_here(f"cohort {files} --permutations 9 --report page.html", tmp_path)
    assert done.returncode == 0, done.stderr
    page = (tmp_path / "page.html").read_text()
    assert page.count("<iframe") == 3 and "m4 against the others" in page


REFUSED = [
    ("skull_0.csv", "of 1 individuals"),
    ("skull_0.csv skull_1.csv skull_2.csv --replicates 2", "3 specimens; allowed is a multiple"),
    ("skull_0.csv skull_1.csv --replicates 0", "replicates is 0"),
    ("skull_0.csv skull_1.csv --replicates two", "replicates is 'two'"),
    ("skull_0.csv skull_1.csv --permutations many", "permutations is 'many'"),
    ("skull_0.csv none.csv", "none.csv: there is no such file"),
    (
        "skull_0.csv skull_1.csv copy.csv",
        "copy.csv: its points are those of skull_0.csv, to the last",
    ),
    ("clash_0.csv clash_1.csv", "clash_0: 'l_a' and 'L_A' both say left of the same landmark"),
    (
        "skull_0.csv lacks.csv",
        "lacks.csv: its landmarks are not those of skull_0.csv: it misses l_a",
    ),
    ("skull_0.csv missing.csv", "missing.csv: landmark l_a is missing"),
    ("skull_0.csv alike.csv", "alike.csv: two landmarks are called 'l_a'"),
    ("skull_0.csv m0.off", "m0.off: of this and skull_0.csv one has landmarks"),
    ("m0.off m1.off", "m1.off: its faces are not those of m0.off"),
    ("skull_0.csv skull_1.csv --pairs none.csv", "none.csv"),
    ("skull_0.csv skull_1.csv --pairs wrong.csv", "wrong.csv: line 1: 'l_z' is no landmark"),
    ("skull_0.csv skull_1.csv --pairs wide.csv", "wide.csv: line 2: there are 3 cells"),
    ("skull_0.csv skull_1.csv --pairs twice.csv", "twice.csv: line 2: one of the two stands twice"),
    (
        "skull_0.csv skull_1.csv --compare nobody",
        "compare is 'nobody', the name of 0 individuals; allowed is that of one: skull_0, skull_1",
    ),
    ("skull_0.csv skull_1.csv --table anova.txt", "allowed is the suffix .csv"),
    ("skull_0.csv skull_1.csv --table skull_0.csv", "is an input or another output"),
    ("skull_0.csv skull_1.csv --individuals a.csv --table a.csv", "is an input or another output"),
]


@pytest.mark.parametrize("line, reason", REFUSED)
def test_command_line_refuses(line, reason, rng, tmp_path):
    """With the reason in one line, and nothing written."""
    write_landmarks(tmp_path, sample(rng, n=3, r=1), NAMES)
    text = (tmp_path / "skull_0.csv").read_text()
    row = next(each for each in text.splitlines() if each.startswith("l_a"))
    (tmp_path / "lacks.csv").write_text(text.replace(f"{row}\n", ""))
    (tmp_path / "alike.csv").write_text(text.replace("l_b", "l_a"))
    (tmp_path / "missing.csv").write_text(text.replace(row, "l_a,,,"))
    header, *rows = text.splitlines()
    (tmp_path / "copy.csv").write_text("\n".join([header, *reversed(rows)]))
    for i in (0, 1):
        own = (tmp_path / f"skull_{i}.csv").read_text()
        (tmp_path / f"clash_{i}.csv").write_text(own.replace("r_a", "L_A"))
    (tmp_path / "wrong.csv").write_text("l_z,r_z\n")
    (tmp_path / "wide.csv").write_text("l_a,r_a\nl_a,r_a,n1\n")
    (tmp_path / "twice.csv").write_text("l_a,r_a\nl_a,r_b\n")
    for i, faces in enumerate(np.array([[[0, 1, 2]], [[0, 2, 1]]])):
        write_mesh(tmp_path / f"m{i}.off", rng.normal(size=(3, 3)), faces)
    before = sorted(tmp_path.iterdir())
    options = "" if "--table" in line else " --table table.csv"
    done = run_here(f"cohort {line}{options}", tmp_path)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.startswith("symsurf: ") and reason in done.stderr
    assert done.stderr.count("\n") == 1 and sorted(tmp_path.iterdir()) == before
