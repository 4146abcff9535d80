"""Reports, opened in Chromium as their readers do."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from command_line import run, run_here
from symmetric_shapes import lopsided_blob

import symsurf

pyvista = pytest.importorskip("pyvista")
pytest.importorskip("trame_vtk", reason="needs trame-vtk: pip install 'symsurf[report]'")

# As on a machine without a graphics card; nothing of the browser's own goes to the network.
BROWSER = [
    "--headless", "--no-sandbox", "--disable-gpu", "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--hide-scrollbars", "--virtual-time-budget=60000",
]  # fmt: skip
WIDTH, HEIGHT = 1000, 900


@pytest.fixture
def browse(tmp_path):
    """Opens a page in Chromium: its picture, (height, width, 3)."""
    program = shutil.which("chromium")
    if program is None:
        pytest.skip("there is no chromium")

    def picture_of(page: Path) -> np.ndarray:
        picture = tmp_path / f"{page.stem}.seen.png"
        command = [program, *BROWSER, f"--user-data-dir={tmp_path / 'chromium'}"]
        command += [f"--window-size={WIDTH},{HEIGHT}", f"--screenshot={picture}", page.as_uri()]
        subprocess.run(command, check=True, capture_output=True, timeout=120)
        seen = pyvista.read(picture)
        columns, rows, _ = seen.dimensions
        return np.array(seen["PNGImage"]).reshape(rows, columns, -1)[::-1, :, :3].astype(int)

    return picture_of


@pytest.fixture
def ball(tmp_path):
    """A sphere's mesh with a dent on one side of x = 0, in input units of its radius."""
    mesh = pyvista.Icosphere(radius=1, nsub=4)
    points = np.array(mesh.points, dtype=float)
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    off = ((points - np.array([0.77, 0.5, 0.4])) ** 2).sum(axis=1) / 0.2
    points *= (1 - np.where(off < 1, 0.1 * (1 - off) ** 2, 0))[:, None] * (1, 1.3, 0.8)
    path = tmp_path / "ball.ply"
    symsurf.straighten(symsurf.Shape(points, mesh.regular_faces), symsurf.Plane((1, 0, 0), 0)).save(
        path
    )
    return path


def told(page: str) -> str:
    """What a page says, without its frames."""
    return re.sub(r'srcdoc="[^"]*"', "", page)


def coloured(picture: np.ndarray) -> int:
    """How many pixels have a colour."""
    return int(np.count_nonzero(np.ptp(picture, axis=2) > 25))


def test_page_of_a_mesh(ball, browse, tmp_path):
    page = tmp_path / "made" / "report.html"
    done = run("report", ball, "--output", page, "--unit", "mm", "--method", "plane")
    assert done.returncode == 0 and done.stderr == ""
    assert (
        done.stdout.splitlines()[-1] == f"  written   {page}"
        and "ball.ply: found, plane" in done.stdout
    )
    text = told(page.read_text())
    asymmetry = symsurf.asymmetry(ball, symsurf.detect(ball, "plane"))
    for name, title in (("maximum", "maximum"), ("rms", "rms"), ("p95", "95th percentile")):
        value, share = asymmetry.statistics[name], asymmetry.statistics[f"{name}_of_diagonal"]
        row = f'<td>{title}</td><td class="number">{value:.4f}</td>'  # of a diagonal of some mm
        assert f'{row}<td class="number">{100 * share:.3f}</td>' in text
    assert ">mm</th>" in text and "<svg" in text and "max distance" in text
    assert "unmatched" not in text  # none is
    picture = browse(page)
    frame = picture[150:750]
    # The mirror's blue rim; the dent, red; the bulge it leaves on the other side, blue or red.
    assert coloured(frame) > 3000
    assert np.count_nonzero((frame[..., 0] - frame[..., 2]) > 60) > 300


def test_an_inspection_is_printed_with_six_sides_and_signed(ball, browse, tmp_path):
    page = tmp_path / "part.html"
    bands = ["--bands", "0.01,0.05", "--unit", "mm", "--method", "plane"]
    done = run("asymmetry", ball, "--output", page, *bands)
    assert done.returncode == 0, done.stderr
    content = page.read_text()
    text = told(content)
    for word in ("part", "date", "symmetry value", "settings", "versions", "Signature"):
        assert f">{word}<" in text
    assert "Tolerance bands" in text and "NumPy " in text and "ball.ply" in text
    assert text.count("<figure>") == 6 and "from -z" in text
    # As it is on paper: without the scene, which does not run there.
    printed = tmp_path / "printed.html"
    printed.write_text(content.replace("@media print {", "@media all {"))
    seen = browse(printed)
    assert coloured(seen) > 5_000
    plain = tmp_path / "plain.html"
    assert run("asymmetry", ball, "--output", plain, "--method", "plane").returncode == 0
    assert "Signature" not in told(plain.read_text())


def test_the_page_turns(ball, browse, tmp_path):
    """A drag by the mouse shows another side, a page that is left alone does not change."""
    from symsurf.plotting.drawing import new_plotter
    from symsurf.plotting.operation_plotting import draw
    from symsurf.report.scene import viewer_page

    plotter = new_plotter(off_screen=True)
    draw(plotter, symsurf.asymmetry(ball))
    still = viewer_page(plotter)
    plotter.close()
    drag = """<script>setTimeout(() => {
      const canvas = document.querySelector('canvas');
      const send = (name, x, y, buttons) => canvas.dispatchEvent(new PointerEvent(name, {
        clientX: x, clientY: y, button: 0, buttons, bubbles: true, pointerId: 1, isPrimary: true,
        pointerType: 'mouse'}));
      send('pointerdown', 500, 450, 1);
      for (let i = 1; i <= 20; ++i) send('pointermove', 500 + 15 * i, 450, 1);
      send('pointerup', 800, 450, 0);
    }, 3000)</script>"""
    pages = {"still": still, "again": still, "turned": still.replace("</body>", drag + "</body>")}
    seen = {}
    for name, content in pages.items():
        (tmp_path / f"{name}.html").write_text(content)
        seen[name] = browse(tmp_path / f"{name}.html")
    assert np.array_equal(seen["still"], seen["again"])
    assert np.count_nonzero(np.abs(seen["still"] - seen["turned"]).max(axis=2) > 25) > 10000


def test_a_page_asks_for_nothing(ball, tmp_path):
    page = tmp_path / "report.html"
    assert run("report", ball, "--output", page).returncode == 0
    content = page.read_text()
    assert "Content-Security-Policy\" content=\"default-src 'none'" in content
    assert not re.search(r"""\b(src|href)\s*=\s*["']?(https?:)?//""", told(content))


def test_pages_of_many(ball, browse, tmp_path):
    shape = symsurf.read(ball)
    sides = np.linspace(0, 1, 5)
    for i, strength in enumerate(sides):
        even = symsurf.symmetrize(
            shape, symsurf.Plane((1, 0, 0), 0), side="negative", strength=strength
        )
        even.save(tmp_path / f"b & {i}.ply")
    (tmp_path / "broken.ply").write_text("ply\n")
    files = [tmp_path / f"b & {i}.ply" for i in range(5)]
    page = tmp_path / "cohort.html"
    words = ("--jobs", "2", "--method", "plane", "--table", tmp_path / "t.csv")
    done = run("report", *files, tmp_path / "broken.ply", "--output", page, *words)
    assert done.returncode == 1 and done.stderr.count("\n") == 1
    text = page.read_text()
    assert "5 of 6 files have a mirror" in text and "end_header" in text
    rms = [symsurf.asymmetry(file, symsurf.detect(file, "plane")).statistics["rms_of_diagonal"]
           for file in files]  # fmt: skip
    row = re.search(r"<td>rms</td>(.*?)</tr>", text)
    figures = [float(value) for value in re.findall(r">([-.\de]+)</td>", row[1])]
    expected = np.percentile(100 * np.array(rms), (0, 5, 25, 50, 75, 95, 100))
    np.testing.assert_allclose(figures[:-1], expected, rtol=0, atol=6e-4)
    assert figures[-1] == 5
    assert re.findall(r">(\d) of 5</td>", text) == [
        str(1 + sum(other < own for other in rms)) for own in rms
    ]
    for i in range(5):
        assert f'<a href="cohort_files/b%20%26%20{i}.html">b &amp; {i}.ply</a>' in text
        assert (tmp_path / "cohort_files" / f"b & {i}.html").exists()
        assert f'src="cohort_files/b%20%26%20{i}.png"' in text
        assert (tmp_path / "cohort_files" / f"b & {i}.png").exists()
    assert not re.search(r">-?[\d.]+e-\d+</td>", text)
    assert coloured(browse(page)) > 10_000  # the bars, and a picture a file
    assert (tmp_path / "t.csv").read_text().count("\n") == 7


def test_names_and_contents_of_files_are_no_code(ball, tmp_path):
    names = ["<script>alert(1)<", '<img src=x onerror="alert(1)">.ply', "<b>good<.ply", "a&b.ply"]
    for name in names[:2]:
        (tmp_path / name).write_text("ply\n<svg/onload=alert(1)>\n")
    for name in names[2:]:
        (tmp_path / name).write_bytes(ball.read_bytes())
    words = ("--input-format", "ply", "--unit", "<i>mm", "--method", "plane")
    done = run("report", *names, "--output", "<u>all.html", *words, cwd=tmp_path)
    assert done.returncode == 1
    pages = [tmp_path / "<u>all.html", *(tmp_path / "<u>all_files").glob("*.html")]
    assert len(pages) == 3
    for page in pages:
        text = told(page.read_text())
        assert not re.search(r"<(script|img src=x|svg/|b>|i>|u>)", text)
        policy = re.search(r'Security-Policy" content="([^"]*)"', text)[1]
        scripts = re.search(r"script-src ([^;]*)", policy)[1]
        assert "unsafe-inline" not in scripts and "default-src 'none'" in policy
        if page == pages[0]:
            assert scripts == "'none'"
    assert "&lt;b&gt;good&lt;.ply" in pages[0].read_text()


def test_a_script_that_was_smuggled_in_does_not_run(ball, browse, tmp_path):
    """Whatever escapes escaping: the policy stops it."""
    page = tmp_path / "report.html"
    assert run("report", ball, "--output", page, "--method", "plane").returncode == 0
    before = browse(page)
    red = "<script>document.body.innerHTML = ''</script><img src=x onerror=document.body.remove()>"
    page.write_text(page.read_text().replace("<h1>", red + "<h1>"))
    assert coloured(browse(page)) > coloured(before) / 2


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("report ball.ply --input-format ply --output ball.ply", "allowed is the suffix .html"),
        ("report ball.html --input-format ply --output ball.html", "would overwrite an input"),
        ("report ball.ply --output report.pdf", "allowed is the suffix .html"),
        ("report ball.ply --output report.html --max-angle 1000", "max_angle"),
        ("report ball.ply folder/ball.ply --output r.html", "both be written as ball.html"),
    ],
)
def test_what_is_wrong_is_named(ball, line, says, tmp_path):
    done = run_here(line, tmp_path)
    assert done.returncode == 2 and says in done.stderr
    assert not list(tmp_path.glob("**/*.html"))


def test_a_mirror_that_is_none_has_a_page_unless_refused(tmp_path):
    np.savetxt(tmp_path / "none.xyz", lopsided_blob(800))
    done = run_here("report none.xyz --output report.html --require-found", tmp_path)
    assert done.returncode == 1 and "has no mirror" in done.stderr
    assert not (tmp_path / "report.html").exists()
    shutil.copy(tmp_path / "none.xyz", tmp_path / "twin.xyz")
    done = run_here("report none.xyz twin.xyz --output report.html", tmp_path)
    assert done.returncode == 0 and done.stderr.count("the verdict on the mirror is") == 2
    assert "0 of 2 files have a mirror. 2 more" in (tmp_path / "report.html").read_text()
    assert "Verdict none: " in (tmp_path / "report_files" / "none.html").read_text()


def test_without_the_packages_one_sentence(ball, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "trame_vtk", None)
    done = run_here("report ball.ply --output report.html", ball.parent)
    assert done.returncode == 2
    assert done.stderr == (
        "symsurf: reports need PyVista and trame-vtk: pip install 'symsurf[report]'\n"
    )
