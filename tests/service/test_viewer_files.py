"""The built viewer as it goes over the wire: how much it weighs, and whose pages may hold it."""

from __future__ import annotations

import gzip
from pathlib import Path

import pytest
from conftest import LOCAL, settings_in
from starlette.testclient import TestClient

from service.app import create_app
from service.settings import Settings

MOST_BYTES = 300_000
"""Of the viewer's scripts and styles, compressed, without textures."""
CHAT = "https://chat.example"


def test_the_viewer_is_light() -> None:
    folder = Settings().viewer_dir
    files = [path for path in folder.rglob("*") if path.suffix in {".js", ".css", ".html"}]
    if not files:
        pytest.skip("the viewer is not built: `npm --prefix static run build`")
    assert {"embed.js", "index.html"} < {path.name for path in files}
    weights = {path.name: len(gzip.compress(path.read_bytes(), mtime=0)) for path in files}
    assert sum(weights.values()) < MOST_BYTES, weights


@pytest.mark.parametrize("page", ["/", "/index.html", "/embed.js", "/?embed=1"])
@pytest.mark.parametrize(
    ("allowed", "holders"), [((), "'self'"), ((CHAT, "http://localhost:3000"), None)]
)
def test_only_pages_that_may_drive_a_face_may_hold_it(
    tmp_path: Path, page: str, allowed: tuple[str, ...], holders: str | None
) -> None:
    for name in ("index.html", "embed.js"):
        (tmp_path / name).write_text("a file")
    app = create_app(settings_in(tmp_path, viewer_dir=tmp_path, allowed_origins=allowed))
    headers = TestClient(app, base_url=LOCAL).get(page).headers
    expected = holders or f"'self' {CHAT} http://localhost:3000"
    assert headers["Content-Security-Policy"] == f"frame-ancestors {expected}"
    # An older header would overrule it in browsers that know only that one.
    assert "X-Frame-Options" not in headers
    assert headers["X-Content-Type-Options"] == "nosniff"


def test_an_embed_of_an_unknown_origin_is_not_given_the_script(tmp_path: Path) -> None:
    (tmp_path / "index.html").write_text("a page")
    (tmp_path / "embed.js").write_text("a script")
    app = create_app(settings_in(tmp_path, viewer_dir=tmp_path, allowed_origins=(CHAT,)))
    client = TestClient(app, base_url=LOCAL)
    known = client.get("/embed.js", headers={"Origin": CHAT})
    assert known.status_code == 200
    assert known.headers["Access-Control-Allow-Origin"] == CHAT
    assert client.get("/embed.js", headers={"Origin": "https://evil.example"}).status_code == 403
