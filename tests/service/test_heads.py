"""HEAD of files: what GET says of them, without their bytes."""

from __future__ import annotations

import pytest
from starlette.testclient import TestClient

SMILE = {"timeline": [{"time": 0.0, "facs": "12C"}], "duration": 0.1, "textures": False}


@pytest.fixture(scope="module")
def clip(client: TestClient) -> str:
    answer = client.post("/api/clips", params={"wait": 60}, json={**SMILE, "level": "low"})
    assert answer.status_code == 200, answer.text
    return answer.headers["Location"]


@pytest.mark.parametrize("ending", [".glb", ".csv"])
def test_a_clip_s_file_is_told_of(client: TestClient, clip: str, ending: str) -> None:
    got, told = client.get(clip + ending), client.head(clip + ending)
    assert (told.status_code, told.content) == (200, b"")
    assert len(got.content) > 0
    for name in ("Content-Length", "Content-Type", "ETag", "Repr-Digest"):
        assert told.headers[name] == got.headers[name]
    fresh = client.head(clip + ending, headers={"If-None-Match": got.headers["ETag"]})
    assert fresh.status_code == 304


def test_files_of_a_rig_are_told_of(client: TestClient) -> None:
    path = "/api/rigs/standard/surface.glb?level=low"
    got, told = client.get(path), client.head(path)
    assert (told.status_code, told.content) == (200, b"")
    assert told.headers["ETag"] == got.headers["ETag"]


def test_what_is_not_there_is_not_told_of(client: TestClient) -> None:
    answer = client.head("/api/clips/nobody.glb")
    assert (answer.status_code, answer.content) == (404, b"")


@pytest.mark.parametrize(
    "path", ["/api/clips", "/api/clips/a/events", "/api/sessions/a/recording.glb", "/api/rigs"]
)
def test_other_addresses_answer_as_before(client: TestClient, path: str) -> None:
    assert client.head(path).status_code == 405
