"""The code of the documentation that needs the package; the rest is run by the tests of the library."""

import pathlib
import re
import shutil

import pytest

from test_results import BALL, DATA

ROOT = pathlib.Path(__file__).parents[2]
PAGES = ["README.md", "python/README.md", "docs/python.md"]
BLOCKS = [
    (page, block)
    for page in PAGES
    for block in re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(), re.DOTALL)
    if "import fretwear" in block
]


@pytest.mark.parametrize("page, block", BLOCKS)
def test_the_code_of_a_page_runs(page, block, tmp_path, monkeypatch, capsys):
    pytest.importorskip("joblib")
    shutil.copy(BALL, tmp_path / "paraboloid.toml")
    shutil.copy(BALL, tmp_path / "ball.toml")
    (tmp_path / "data").symlink_to(DATA)
    monkeypatch.chdir(tmp_path)
    exec(compile(block, page, "exec"), {})
    assert capsys.readouterr().out


def test_every_page_has_some():
    assert {page for page, _ in BLOCKS} == set(PAGES)
