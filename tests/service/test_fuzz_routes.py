"""Every route is tried by schemathesis with all of its checks: no failure, nothing undocumented.

`RISORIUS_FUZZ_EXAMPLES=1000` tries as many examples of each, `RISORIUS_FUZZ_ROUTES=tissue` only
routes of such a name (a regular expression); `-s` prints a table of what was tried.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import urllib.error
import urllib.request
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest
from conftest import api_routes, until
from fuzz_table import table
from fuzzing import ROUTES, TIMEOUT, WANTED, examples, fuzzed

ROOT = Path(__file__).parents[2]
CONFIGURATION = ROOT / "schemathesis.toml"

pytestmark = pytest.mark.timeout(TIMEOUT)


def ask(url: str, body: object) -> str:
    """Return the id of what is made by a POST."""
    data = json.dumps(body).encode()
    request = urllib.request.Request(url, data, {"Content-Type": "application/json"})
    with urllib.request.urlopen(request, timeout=60) as answer:
        return str(json.load(answer)["id"])


def answered(url: str, body: bytes | None) -> bool:
    """Return whether a call is answered; it is not while something has to be made for it."""
    try:
        request = urllib.request.Request(url, body, {"Content-Type": "application/json"})
        urllib.request.urlopen(request, timeout=900).close()
    except urllib.error.HTTPError as error:
        return error.code != 503
    return True


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A service of its own."""
    with fuzzed(tmp_path_factory.mktemp("fuzz")) as (address, _):
        if WANTED and any(re.search(ROUTES, route) for route in DEAR):
            for path, body in FIRST_TIMES.items():
                until(partial(answered, f"{address}{path}", body), seconds=900)
        yield address


DEAR = (
    "POST /api/rigs/{rig}/inverse",
    "GET /api/rigs/{rig}.glb",
    "GET /api/rigs/{rig}/expressions/{facs}.glb",
    "GET /api/rigs/{rig}/expressions/{facs}.png",
)
"""Routes with answers that take half a minute the first time: a few examples leave those out."""
FIRST_TIMES = {
    "/api/rigs/standard.glb": None,
    "/api/rigs/standard/expressions/0.glb": None,
    "/api/rigs/standard/expressions/0.png": None,
    "/api/rigs/standard/inverse?wait=60": b'{"targets": {"48": [null, 1, null]}}',
}
"""What of those is asked before many examples are: they share what it makes, and none waits."""
NOBODY = {"rig": "nobody"}
"""Where those are sent instead: left to itself, schemathesis finds "standard" in other answers."""


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


def aimed(kept: dict[str, str], gone: dict[str, str]) -> str:
    """Return the configuration by which routes are tried on what is there.

    Args:
        kept: Parameters of paths by name; empty leaves paths to schemathesis.
        gone: Those of the routes that take it away.
    """
    lines = [CONFIGURATION.read_text(encoding="utf-8")]
    for method, path in api_routes():
        route = f"{method} {path}"
        given = gone if method == "DELETE" and path.endswith("}") else kept
        if route in DEAR and not WANTED:
            given = NOBODY
        named = [name for name in re.findall(r"{(\w+)}", path) if name in given]
        values = ", ".join(f'"path.{name}" = "{given[name]}"' for name in named)
        if named:
            lines += ["[[operations]]", f'include-name = "{route}"']
            lines += [f"parameters = {{ {values} }}"]
    return "\n".join(lines)


def tried(url: str, configuration: str, folder: Path, *options: str) -> None:
    """Run schemathesis with all checks; it must find nothing. Print what was tried."""
    file, report = folder / "schemathesis.toml", folder / "report.ndjson"
    file.write_text(configuration, encoding="utf-8")
    program = Path(sys.executable).with_name("schemathesis")
    command = [
        *(str(program), "--config-file", str(file), "run", f"{url}/openapi.json"),
        *("--checks", "all", "--request-timeout", "60", "--suppress-health-check", "all"),
        *("--no-color", "--warnings", "off", *options),
        *("--report", "ndjson", "--report-ndjson-path", str(report)),
        *(("--include-name-regex", ROUTES) if ROUTES else ()),
    ]
    done = subprocess.run(command, capture_output=True, text=True, cwd=folder)
    print("\n" + table(report))  # noqa: T201
    report.unlink()  # Hundreds of megabytes, where a thousand examples are wanted.
    assert done.returncode == 0, done.stdout[-20_000:] + done.stderr


def test_routes_on_what_is_there(url: str, tmp_path: Path) -> None:
    count = examples(4)
    configuration = aimed(there(url), there(url))
    tried(url, configuration, tmp_path, "--phases", "examples,fuzzing", f"--max-examples={count}")


def test_routes_on_anything_and_one_after_another(url: str, tmp_path: Path) -> None:
    """With WANTED examples every bound of the schema is tried as well, thousands of cases."""
    configuration = aimed({}, {})
    phases = "examples,coverage,fuzzing,stateful" if WANTED else "fuzzing,stateful"
    tried(url, configuration, tmp_path, "--phases", phases, f"--max-examples={examples(3)}")
