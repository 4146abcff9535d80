"""What the command line says of itself: overview, help, suggestions, completion."""

from __future__ import annotations

import re
import shutil
import subprocess

import pytest
from command_line import run_here

import symsurf
from symsurf import cli
from symsurf.cli.commands import COMMANDS, example_of


@pytest.mark.parametrize("line", ["", "--help", "-h"])
def test_alone_it_shows_every_command_with_an_example(line, tmp_path):
    done = run_here(line, tmp_path)
    assert done.returncode == 0 and done.stderr == ""
    for name in COMMANDS:
        assert re.search(rf"^  {name} ", done.stdout, re.MULTILINE)
        assert f"$ {example_of(name)}" in done.stdout
    assert max(map(len, done.stdout.splitlines())) <= 100


@pytest.mark.parametrize("name", COMMANDS)
def test_examples_are_commands(name):
    _, given, *words = example_of(name).split()
    assert given == name
    cli.parser_of(name).parse_args(words)


def test_only_the_chosen_parser_is_built(monkeypatch, tmp_path):
    built = []
    parser_of = cli.parser_of
    monkeypatch.setattr(cli, "parser_of", lambda name: built.append(name) or parser_of(name))
    assert run_here("methods", tmp_path).returncode == 0
    assert built == ["methods"]


@pytest.mark.parametrize("method", symsurf.methods())
def test_help_shows_the_parameters_of_the_method(method, tmp_path):
    said = run_here(f"detect --method {method} --help", tmp_path).stdout
    shown = set(
        re.findall(r"^  --([\w-]+)", said.split("parameters of the method:")[1], re.MULTILINE)
    )
    own = {each.name.replace("_", "-") for each in symsurf.methods()[method].parameters}
    assert shown == own


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("asymetry scan.ply", "no command 'asymetry'; did you mean asymmetry?"),
        ("--versoin", "no option '--versoin'"),
        ("align scan.xyz --axsi x", "did you mean --axis?"),
        ("detect scan.xyz --method plan", "did you mean plane?"),
        ("detect scan.xyz --method plane --tolerence 1", "did you mean --tolerance?"),
        ("align scan.xyz --frame lsp", "did you mean lps?"),
        ("align scan.xyz --output made --format pyl", "did you mean ply?"),
        ("completion bahs", "did you mean bash?"),
    ],
)
def test_misspelt_words_are_corrected(line, says, tmp_path):
    (tmp_path / "scan.xyz").write_text("\n".join(f"{i} {i * i} {i % 3}" for i in range(20)))
    done = run_here(line, tmp_path)
    assert done.returncode == 2 and says in done.stderr and done.stdout == ""


def test_what_is_like_no_word_gets_no_suggestion(tmp_path):
    assert "did you mean" not in run_here("xyzzy", tmp_path).stderr


def test_bash_completes(tmp_path):
    script = run_here("completion bash", tmp_path).stdout

    def completed(*words: str) -> set[str]:
        line = " ".join(f"'{word}'" for word in words)
        code = f"COMP_WORDS=({line}); COMP_CWORD={len(words) - 1}; _symsurf; echo ${{COMPREPLY[*]}}"
        done = subprocess.run(
            ["bash", "-c", f"{script}\n{code}"], capture_output=True, text=True, check=True
        )
        return set(done.stdout.split())

    assert completed("symsurf", "") == set(COMMANDS)
    assert completed("symsurf", "sym") == {"symmetrize", "symmetries", "symmetry_embedding"}
    assert completed("symsurf", "align", "--ax") == {"--axis"}
    assert completed("symsurf", "align", "--axis", "") == {"x", "y", "z"}
    assert completed("symsurf", "detect", "--method", "plane_") == {
        "plane_icp",
        "plane_svd",
        "plane_hruda",
    }
    assert "spherical" in completed("symsurf", "generate", "")
    assert completed("symsurf", "detect", "scan") == set()  # files are the shell's


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_scripts_are_sound(shell, tmp_path):
    script = run_here(f"completion {shell}", tmp_path).stdout
    assert all(name in script for name in COMMANDS)
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is not installed")
    done = subprocess.run([shell, "-n"], input=script, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and done.stderr == ""
