"""How long clips are kept, and what a service that was killed in the middle leaves of them."""

from __future__ import annotations

import json
import sqlite3
import time
import urllib.error
import urllib.request
from pathlib import Path

import pytest
from conftest import LOCAL, parts_of, settings_in, until
from starlette.testclient import TestClient

import service.clips
from service.app import create_app
from service.starting import service as started_service

SHORT = {
    "timeline": [{"time": 0, "action_units": {"AU12": 1}}],
    **{"textures": False, "level": "low", "fps": 5, "duration": 0.2},
}
DAY = 86_400.0


def test_what_is_old_is_forgotten(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(service.clips, "_SWEEP_SECONDS", 0.05)
    with TestClient(create_app(settings_in(tmp_path, clip_days=2.0)), base_url=LOCAL) as client:
        until(lambda: client.get("/api/ready").status_code == 200, seconds=120)
        parts = parts_of(client)
        old, young = (client.post("/api/clips", json=SHORT).json()["id"] for _ in range(2))
        until(
            lambda: all(
                client.get(f"/api/clips/{c}").json()["status"] == "done" for c in (old, young)
            ),
            seconds=180,
        )
        database = sqlite3.connect(tmp_path / "data" / "risorius.sqlite3", timeout=10)
        then = time.time() - 2.0 * DAY - 1.0
        with database:
            database.execute("UPDATE clips SET finished = ? WHERE id = ?", (then, old))
        database.close()
        for path in (old, f"{old}.glb", f"{old}.csv", f"{old}/events"):
            gone = client.get(f"/api/clips/{path}")
            assert gone.status_code == 404
            assert "kept for 2 days" in gone.json()["message"]
        assert [row["id"] for row in client.get("/api/clips").json()["clips"]] == [young]
        until(lambda: parts.store.clip_count() == 1)
        names = {path.name for path in parts.settings.clips_folder.iterdir()}
        assert names == {f"{young}.glb", f"{young}.csv"}


def test_a_start_removes_what_a_killed_service_left(tmp_path: Path) -> None:
    settings = settings_in(tmp_path)
    folder = settings.clips_folder
    folder.mkdir(parents=True)
    name, other = "0" * 32, "f" * 32
    gone = (f"{name}.glb.123", f"{name}.csv.9", f"{name}.upload", f"{other}.track")
    kept = (f"{name}.glb", f"{name}.csv", "notes.txt", f"{name}.glb.bak", "laugh.track")
    for each in (*gone, *kept):
        (folder / each).write_bytes(b"half")
    with TestClient(create_app(settings), base_url=LOCAL):
        assert {path.name for path in folder.iterdir()} == set(kept)


def test_a_tracker_s_clip_survives_a_kill_and_is_done(tmp_path: Path) -> None:
    environment = {"RISORIUS_DATA_DIR": str(tmp_path)}
    folder = tmp_path / "clips"
    rows = "\n".join(f"{i},{i / 30:.3f},0.98,1,{i % 5}" for i in range(300))
    content = f"frame,timestamp,confidence,success,AU12_r\n{rows}\n".encode()

    def post(url: str) -> str:
        address = f"{url}/api/clips?textures=0&fps=5&level=low&gain=0.5"
        request = urllib.request.Request(address, content, {"Content-Type": "text/csv"})
        with urllib.request.urlopen(request, timeout=120) as answer:
            return str(json.load(answer)["id"])

    with started_service(environment) as started:
        clips = [post(started.url) for _ in range(2)]  # One is begun, and one waits.
        started.process.kill()
        started.process.wait()
    assert f"{clips[1]}.track" in {path.name for path in folder.iterdir()}
    (folder / f"{clips[0]}.glb.12345").write_bytes(b"half of it")
    with started_service(environment) as again:
        for clip in clips:
            row = {"status": "queued"}
            while row["status"] in ("queued", "running"):
                row = again.ask("GET", f"/api/clips/{clip}?wait=10", None)
            assert row["status"] == "done", row
            assert row["report"]["track"]["gain"] == 0.5
        names = {path.name for path in folder.iterdir()}
        assert names == {f"{clip}.{suffix}" for clip in clips for suffix in ("glb", "csv")}
