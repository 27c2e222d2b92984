"""Every route is tried by schemathesis with all of its checks: no failure, nothing undocumented.

`RISORIUS_FUZZ_EXAMPLES=1000` tries as many examples of each.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import api_routes
from fuzzing import WANTED, examples, fuzzed

ROOT = Path(__file__).parents[2]
CONFIGURATION = ROOT / "schemathesis.toml"


def ask(url: str, body: object) -> str:
    """Return the id of what is made by a POST."""
    data = json.dumps(body).encode()
    request = urllib.request.Request(url, data, {"Content-Type": "application/json"})
    with urllib.request.urlopen(request, timeout=60) as answer:
        return str(json.load(answer)["id"])


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A service of its own."""
    with fuzzed(tmp_path_factory.mktemp("fuzz")) as (address, _):
        yield address


INVERSE = "POST /api/rigs/{rig}/inverse"
MOST_INVERSES = 30
"""Of a rig that is there: each that is not refused takes seconds of a core."""
DEAR = (INVERSE, "GET /api/rigs/{rig}.glb")
"""Routes with answers that take half a minute the first time: a few examples leave those out."""


def there(url: str) -> dict[str, str]:
    """Return the parameters of paths that lead to something."""
    clip = {"timeline": [{"time": 0}], "duration": 0.1, "textures": False, "level": "low"}
    return {
        "session_id": ask(f"{url}/api/sessions", {}),
        "clip": ask(f"{url}/api/clips", clip),
        "rig": "standard",
        "muscle": "zygomatic_major.L",
        "file": "albedo.jpg",
    }


def aimed(kept: dict[str, str], gone: dict[str, str], count: int) -> str:
    """Return the configuration by which routes are tried on what is there.

    Args:
        kept: Parameters of paths by name.
        gone: Those of the routes that take it away.
        count: Examples of each route.
    """
    lines = [CONFIGURATION.read_text(encoding="utf-8")]
    for method, path in api_routes():
        given = gone if method == "DELETE" and path.endswith("}") else kept
        if f"{method} {path}" in DEAR and not WANTED:
            continue  # It is asked for rigs that are not there, which costs nothing.
        named = [name for name in re.findall(r"{(\w+)}", path) if name in given]
        if named:
            values = ", ".join(f'"path.{name}" = "{given[name]}"' for name in named)
            lines += ["[[operations]]", f'include-name = "{method} {path}"']
            lines += [f"parameters = {{ {values} }}"]
        if f"{method} {path}" == INVERSE:
            lines += [f"generation.max-examples = {min(count, MOST_INVERSES)}"]
    return "\n".join(lines)


def tried(url: str, configuration: str, folder: Path, *options: str) -> None:
    """Run schemathesis with all checks; it must find nothing."""
    file = folder / "schemathesis.toml"
    file.write_text(configuration, encoding="utf-8")
    program = Path(sys.executable).with_name("schemathesis")
    command = [
        *(str(program), "--config-file", str(file), "run", f"{url}/openapi.json"),
        *("--checks", "all", "--request-timeout", "60", "--suppress-health-check", "all"),
        *("--no-color", "--warnings", "off", *options),
    ]
    done = subprocess.run(command, capture_output=True, text=True, cwd=folder)
    assert done.returncode == 0, done.stdout[-20_000:] + done.stderr
    print(done.stdout[done.stdout.rfind("Test cases:") :])  # noqa: T201


def test_routes_on_what_is_there(url: str, tmp_path: Path) -> None:
    count = examples(4)
    configuration = aimed(there(url), there(url), count)
    tried(url, configuration, tmp_path, "--phases", "examples,fuzzing", f"--max-examples={count}")


def test_routes_on_anything_and_one_after_another(url: str, tmp_path: Path) -> None:
    """With WANTED examples every bound of the schema is tried as well, thousands of cases."""
    configuration = CONFIGURATION.read_text(encoding="utf-8")
    phases = "examples,coverage,fuzzing,stateful" if WANTED else "fuzzing,stateful"
    tried(url, configuration, tmp_path, "--phases", phases, f"--max-examples={examples(3)}")
