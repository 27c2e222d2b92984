"""Clips of trackers' files over HTTP: streamed to disk, read, rendered, and gone when done."""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import LOCAL, parts_of, settings_in, until
from starlette.testclient import TestClient

from service.app import create_app

CSV = {"Content-Type": "text/csv"}
LINES = {"Content-Type": "application/jsonl"}
QUICK = {"fps": 10, "textures": "false", "level": "low"}
HEADER = "frame, face_id, timestamp, confidence, success, pose_Rx, pose_Ry, pose_Rz, AU06_r, AU12_r"


def openface(rows: int, *, face: int = 0) -> bytes:
    """Return a file of OpenFace 2, thirty rows a second."""
    table = [f"{i + 1},{face},{i / 30:.3f},0.98,1,0.0,0.1,0.0,0.5,{min(i, 4)}" for i in range(rows)]
    return "\n".join([HEADER, *table, ""]).encode()


def folder_of(client: TestClient) -> list[str]:
    """Return what lies in the folder of clips."""
    folder = parts_of(client).settings.clips_folder
    return sorted(path.name for path in folder.glob("*"))


def test_a_tracker_s_file_becomes_an_animation_with_a_report(client: TestClient) -> None:
    answer = client.post(
        "/api/clips", params={**QUICK, "gain": 0.5}, content=openface(7), headers=CSV
    )
    assert answer.status_code == 202, answer.text
    queued = answer.json()
    assert queued["report"]["track"]["rows"] == 7
    place = f"/api/clips/{queued['id']}"
    until(lambda: client.get(place).json()["status"] == "done", seconds=180)  # A first compile.
    clip = client.get(place).json()
    report = clip["report"]
    assert report["track"]["tracker"] == "OpenFace 2"
    assert report["track"]["units"]["AU12"]["played"] == pytest.approx(0.4)
    assert report["duration"] == pytest.approx(7 / 30)
    assert report["warnings"] == report["track"]["notes"]
    assert clip["expires"] == pytest.approx(clip["finished"] + 30 * 86_400)
    (line,) = [
        each for each in client.get("/api/clips").json()["clips"] if each["id"] == clip["id"]
    ]
    assert line == {**clip, "report": {k: v for k, v in report.items() if k != "track"}}
    names = folder_of(client)
    assert f"{clip['id']}.glb" in names
    assert not [name for name in names if name.endswith((".track", ".upload"))]


def test_a_short_one_is_waited_for(client: TestClient) -> None:
    answer = client.post(
        "/api/clips", params={**QUICK, "wait": 60}, content=openface(4), headers=CSV
    )
    assert answer.status_code == 200, answer.text
    assert answer.content[:4] == b"glTF"


@pytest.mark.parametrize("kind", ["application/jsonl", "application/x-ndjson; charset=utf-8"])
def test_json_lines_are_taken_too(client: TestClient, kind: str) -> None:
    lines = [{"timestamp_ms": 33 * i, "blendshapes": {"jawOpen": 0.1 * i}} for i in range(4)]
    body = "\n".join(map(json.dumps, lines))
    asked = {**QUICK, "wait": 60}
    answer = client.post("/api/clips", params=asked, content=body, headers={"Content-Type": kind})
    assert answer.status_code == 200, answer.text
    report = client.get(answer.headers["Location"]).json()["report"]
    assert report["track"]["tracker"] == "MediaPipe"


def test_what_is_asked_for_is_done(client: TestClient) -> None:
    two = openface(6) + openface(6, face=1).partition(b"\n")[2]
    asked = {
        **QUICK,
        **{"wait": 60, "face": "1", "neutral": "auto", "smooth": 2, "confidence": 0.2},
        **{"head": "false", "gaze": "0", "rig": "paper", "seconds": 0.07},
        **{"form": "exact", "tolerance": 0.2, "quantize": "false", "sparse": 0},
    }
    answer = client.post("/api/clips", params=asked, content=two, headers=CSV)
    assert answer.status_code == 200, answer.text
    clip = client.get(answer.headers["Location"]).json()
    track = clip["report"]["track"]
    assert clip["rig"] == client.get("/api/rigs/paper").json()["id"]
    assert (track["face"], track["used"], track["smoothing"]) == ("1", 6, 2.0)
    assert track["angles"] == {}
    assert track["neutral"] is not None
    assert track["left_out"] > 0.0
    assert clip["report"]["duration"] == pytest.approx(2 / 30)
    assert b"KHR_mesh_quantization" not in answer.content


OPENFACE_3 = b"frame,timestamp,AU01_r,AU03_r\n" + b"".join(
    b"%d,%.3f,0.5,%.1f\n" % (i, i / 30, 0.2 * i) for i in range(4)
)


def test_units_that_are_numbered_by_index_play_by_a_map(client: TestClient) -> None:
    asked = {**QUICK, "wait": 60}
    answer = client.post("/api/clips", params=asked, content=OPENFACE_3, headers=CSV)
    assert answer.status_code == 422
    assert "with a map" in answer.json()["message"]
    asked |= {"au_map": "AU01_r:AU1, AU03_r:L4", "full_scale": "2", "max_gap": 0.1}
    answer = client.post("/api/clips", params=asked, content=OPENFACE_3, headers=CSV)
    assert answer.status_code == 200, answer.text
    units = client.get(answer.headers["Location"]).json()["report"]["track"]["units"]
    assert {name: unit["columns"] for name, unit in units.items()} == {
        "AU1": ["AU01_r"],
        "L4": ["AU03_r"],
    }
    assert units["AU1"]["played"] == pytest.approx(0.25, abs=0.02)


@pytest.mark.parametrize(
    ("query", "said"),
    [
        ("au_map=AU01_r", "expected a column and its unit"),
        ("au_map=AU12_r:AU1,AU12_r:AU2", "names the column 'AU12_r' twice"),
        ("au_map=AU01_r:AU1", "the header does not have"),
        ("au_map=AU12_r:SMILE", "the map of 'AU12_r'"),
        ("max_gap=-1", "at least 0"),
        ("full_scale=0", "at least"),
        ("gian=2", "did you mean 'gain'"),
        ("gain=-1", "at least 0"),
        ("gain=nan", "finite"),
        ("fps=0", "at least 1"),
        ("neutral=often", "expected auto"),
        ("neutral=7", "neutral is 7"),
        ("neutral=9-3", "neutral is the frames 9 to 3"),
        ("head=perhaps", "true or false"),
        ("seconds=500", "at most 120 s"),
        ("level=best", "'low'"),
        ("rig=nobody", "nobody"),
    ],
)
def test_what_cannot_be_asked_for_is_said(client: TestClient, query: str, said: str) -> None:
    before = folder_of(client)
    answer = client.post(f"/api/clips?{query}", content=openface(4), headers=CSV)
    assert answer.status_code in (404, 422), answer.text
    assert said in answer.json()["message"]
    assert folder_of(client) == before


def test_a_file_has_its_checksum(client: TestClient) -> None:
    answer = client.post(
        "/api/clips", params={**QUICK, "wait": 60}, content=openface(4), headers=CSV
    )
    location = answer.headers["Location"]
    told = client.get(location).json()["report"]["sha256"]
    for suffix in ("glb", "csv"):
        file = client.get(f"{location}.{suffix}")
        digest = hashlib.sha256(file.content)
        assert told[suffix] == digest.hexdigest()
        assert file.headers["ETag"] == f'"{digest.hexdigest()}"'
        encoded = base64.b64encode(digest.digest()).decode()
        assert file.headers["Repr-Digest"] == f"sha-256=:{encoded}:"
        same = client.get(f"{location}.{suffix}", headers={"If-None-Match": file.headers["ETag"]})
        assert (same.status_code, same.content) == (304, b"")
        part = client.get(f"{location}.{suffix}", headers={"Range": "bytes=0-3"})
        assert (part.status_code, part.content) == (206, file.content[:4])


def test_a_retry_gets_the_same_clip_and_another_file_is_refused(client: TestClient) -> None:
    def post(key: str, content: bytes):
        headers = {**CSV, "Idempotency-Key": key}
        return client.post("/api/clips", params=QUICK, content=content, headers=headers)

    first, again = post("track", openface(4)), post("track", openface(4))
    assert first.status_code == again.status_code == 202
    assert first.json()["id"] == again.json()["id"]
    other = post("track", openface(5))
    assert (other.status_code, other.json()["error"]) == (409, "idempotency_conflict")
    client.get(f"{first.headers['Location']}?wait=60")
    assert not [name for name in folder_of(client) if name.endswith((".track", ".upload"))]


def test_one_on_its_way_is_cancelled_and_leaves_nothing(client: TestClient) -> None:
    before = folder_of(client)
    bare = {"textures": "false"}  # On a cold machine, baking these takes long.
    answers = [
        client.post("/api/clips", params=bare, content=openface(3600), headers=CSV)
        for _ in range(4)  # So many that one of them is on its way whenever somebody looks.
    ]
    places = [answer.headers["Location"] for answer in answers]
    under_way: list[str] = []

    def one_runs() -> bool:
        under_way[:] = [each for each in places if client.get(each).json()["status"] == "running"]
        return bool(under_way)

    until(one_runs)
    for place in (under_way[0], places[-1]):  # One that is rendered, and one that waits.
        assert client.delete(place).status_code == 204
        assert client.get(place).json()["status"] == "cancelled"
    for place in places[:-1]:
        client.delete(place)
    assert folder_of(client) == before
    assert not parts_of(client).clips.under_way


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Iterator[TestClient]:
    """A service that takes little, and one clip at a time."""
    settings = settings_in(
        tmp_path_factory.mktemp("small"), max_upload_bytes=4096, max_clips=3, max_clip_seconds=2.0
    )
    with TestClient(create_app(settings), base_url=LOCAL) as running:
        until(lambda: running.get("/api/ready").status_code == 200, seconds=120)
        yield running


def test_a_large_file_is_refused_by_length_and_by_bytes(small: TestClient) -> None:
    large = openface(200)
    halves = iter([large[:3000], large[3000:]])
    for content in (large, halves):
        answer = small.post("/api/clips", content=content, headers=CSV)
        assert (answer.status_code, answer.json()["error"]) == (413, "body_too_large")
    assert folder_of(small) == []


def test_a_long_one_is_cut_where_clips_end(small: TestClient) -> None:
    rows = "\n".join(f"{i},{i},3" for i in range(30))
    answer = small.post(
        "/api/clips", params=QUICK, content=f"frame,timestamp,AU12_r\n{rows}\n", headers=CSV
    )
    assert answer.status_code == 202, answer.text
    told = answer.json()["report"]["track"]
    assert told["duration"] == 2.0
    assert told["left_out"] > 20.0
    assert small.delete(answer.headers["Location"]).status_code == 204


def test_a_packed_file_is_refused(small: TestClient) -> None:
    answer = small.post(
        "/api/clips", content=openface(4), headers={**CSV, "Content-Encoding": "gzip"}
    )
    assert (answer.status_code, answer.json()["error"]) == (415, "packed_body")
    assert answer.headers["Accept-Encoding"] == "identity"


def test_uploads_and_seconds_of_a_key_are_bounded(tmp_path: Path) -> None:
    settings = settings_in(tmp_path, api_keys=("key",), key_upload_bytes=2000, key_clip_seconds=0.5)
    with TestClient(create_app(settings), base_url=LOCAL) as client:
        until(lambda: client.get("/api/ready").status_code == 200, seconds=120)
        headers = {**CSV, "X-API-Key": "key"}

        def post(content: object, **asked: object):
            params = {**QUICK, **asked}
            return client.post("/api/clips", params=params, content=content, headers=headers)

        made = post(openface(10))
        assert made.status_code == 202, made.text
        long = post(openface(8))  # 0.33 s and 0.27 s.
        assert (long.status_code, long.json()["error"]) == (429, "quota_exceeded")
        large = post(iter([openface(20), openface(20)]))
        assert (large.status_code, large.json()["error"]) == (429, "quota_exceeded")
        assert client.post("/api/clips", content=openface(4), headers=CSV).status_code == 401
        client.get(f"{made.headers['Location']}?wait=60", headers=headers)
        assert sorted({name.partition(".")[2] for name in folder_of(client)}) == ["csv", "glb"]
