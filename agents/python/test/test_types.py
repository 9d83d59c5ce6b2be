"""The package, its tests and the programs of docs/python.md pass `mypy --strict`."""

from pathlib import Path

import saphira
from mypy import api
from test_docs import PROGRAMS


def test_mypy_is_content(tmp_path: Path) -> None:
    for number, text in enumerate(PROGRAMS):
        (tmp_path / f"program{number}.py").write_text(text)
    assert saphira.__file__ is not None
    package = Path(saphira.__file__).parent
    folders = [str(folder) for folder in (package, Path(__file__).parent, tmp_path)]
    output, errors, code = api.run(["--strict", *folders])
    assert code == 0, output + errors
