"""Rigs over HTTP: described, derived, edited live, taken away as GLB."""

from __future__ import annotations

import json
import struct
import time
from pathlib import Path

import pytest
from conftest import LOCAL, parts_of, settings_in, until
from starlette.testclient import TestClient

from service.app import create_app


def glb_json(data: bytes) -> dict[str, object]:
    magic, _, _ = struct.unpack_from("<4sII", data)
    assert magic == b"glTF"
    (length,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20 : 20 + length])


def test_both_built_in_rigs_are_listed(client: TestClient) -> None:
    lines = client.get("/api/rigs").json()["rigs"]
    assert [line["name"] for line in lines[:2]] == ["standard", "paper"]


def test_a_rig_is_described(client: TestClient) -> None:
    rig = client.get("/api/rigs/standard").json()
    assert {"id", "muscles", "action_units", "emotions", "tissue", "mesh"} <= set(rig)
    assert "AU12" in {unit["name"] for unit in rig["action_units"]}
    assert client.get(f"/api/rigs/{rig['id']}").json() == rig


@pytest.mark.parametrize("file", ["standard/surface.glb", "standard/expressions/12C.glb"])
def test_a_file_is_sent_once(client: TestClient, file: str) -> None:
    answer = client.get(f"/api/rigs/{file}")
    assert answer.status_code == 200
    assert answer.headers["Content-Type"] == "model/gltf-binary"
    glb_json(answer.content)
    tag = answer.headers["ETag"]
    again = client.get(f"/api/rigs/{file}", headers={"If-None-Match": tag})
    assert again.status_code == 304
    assert again.content == b""


def test_a_rig_s_file_has_its_units_as_targets(client: TestClient) -> None:
    answer = client.get("/api/rigs/standard.glb")
    assert answer.status_code == 200, answer.text
    rig = client.get("/api/rigs/standard").json()
    assert answer.headers["ETag"].startswith(f'"{rig["id"]}')
    meshes = glb_json(answer.content)["meshes"]
    names = [mesh["extras"]["targetNames"] for mesh in meshes if mesh.get("extras")]
    assert {unit["name"] for unit in rig["action_units"]} <= set(names[0])
    tag = {"If-None-Match": answer.headers["ETag"]}
    assert client.get("/api/rigs/standard.glb", headers=tag).status_code == 304


def images_of(data: bytes) -> list[str]:
    return [image["name"] for image in glb_json(data).get("images", [])]  # type: ignore[attr-defined]


@pytest.mark.parametrize("file", ["standard.glb", "standard/expressions/12C.glb"])
def test_files_embed_the_maps_or_leave_them_out(client: TestClient, file: str) -> None:
    full = client.get(f"/api/rigs/{file}")
    assert set(images_of(full.content)) == {"albedo", "normal", "orm", "eye", "hair_cards"}
    bare = client.get(f"/api/rigs/{file}", params={"textures": 0})
    assert images_of(bare.content) == ["hair_cards"]
    assert bare.headers["ETag"] != full.headers["ETag"]


def test_a_session_s_face_embeds_the_maps(client: TestClient, session: str) -> None:
    assert "albedo" in images_of(client.get(f"/api/sessions/{session}.glb").content)
    bare = client.get(f"/api/sessions/{session}.glb", params={"textures": 0})
    assert images_of(bare.content) == ["hair_cards"]


def test_the_surface_names_its_maps_and_embeds_none(client: TestClient) -> None:
    data = client.get("/api/rigs/standard/surface.glb").content
    extras = glb_json(data)["asset"]["extras"]  # type: ignore[index]
    assert images_of(data) == ["hair_cards"]
    for url in extras["textures"].values():
        answer = client.get(f"/api/rigs/standard/{url}")
        assert answer.status_code == 200
        assert answer.headers["Content-Type"] == "image/jpeg"


def test_the_surface_is_tagged_by_the_rig(client: TestClient) -> None:
    rig = client.get("/api/rigs/standard").json()["id"]
    assert client.get("/api/rigs/standard/surface.glb").headers["ETag"] == f'"{rig}"'


def test_a_rig_s_file_has_arkit_s_shapes_as_targets(client: TestClient) -> None:
    asked = {"names": "arkit", "level": "low", "textures": "0"}
    answer = client.get("/api/rigs/standard.glb", params=asked)
    assert answer.status_code == 200, answer.text
    described = glb_json(answer.content)
    shapes = [*client.get("/api/maps/arkit").json()["shapes"]]
    meshes = {mesh["name"]: mesh for mesh in described["meshes"]}  # type: ignore[attr-defined]
    for name in ("skin", "teeth.lower", "tongue", "eye.L", "eye.R"):
        assert meshes[name]["extras"]["targetNames"] == shapes
    units = client.get("/api/rigs/standard.glb", params={"level": "low", "textures": "0"})
    assert units.headers["ETag"] != answer.headers["ETag"]
    tag = {"If-None-Match": answer.headers["ETag"]}
    assert client.get("/api/rigs/standard.glb", params=asked, headers=tag).status_code == 304
    refused = client.get("/api/rigs/standard.glb", params={"names": "arkti"})
    assert (refused.status_code, refused.json()["error"]) == (422, "unknown_vocabulary")
    assert "did you mean arkit" in refused.json()["message"]


@pytest.mark.parametrize("path", ["zzz", "zzz.glb", "zzz/surface.glb", "zzz/expressions/12C.glb"])
def test_an_unknown_rig_is_not_found(client: TestClient, path: str) -> None:
    answer = client.get(f"/api/rigs/{path}")
    assert answer.status_code == 404
    assert answer.json()["error"] == "unknown_rig"
    assert "standard" in answer.json()["known"]


def test_an_expression_that_cannot_be_read_is_refused(client: TestClient) -> None:
    answer = client.get("/api/rigs/standard/expressions/smile.glb")
    assert answer.status_code == 422


CUSTOM = {
    "base": "standard",
    "tissue": {},
    "action_units": {"AU12": {"muscles": {"zygomatic_major": 0.5}}},
    "emotions": {"smirk": "L12C"},
}


def test_the_same_changes_give_the_same_rig(client: TestClient) -> None:
    first = client.post("/api/rigs", json=CUSTOM)
    assert first.status_code == 201, first.text
    second = client.post("/api/rigs", json=CUSTOM)
    assert second.status_code == 200
    assert second.json()["id"] == first.json()["id"]
    session = client.post("/api/sessions", json={"rig": first.json()["id"]}).json()["id"]
    played = client.post(f"/api/sessions/{session}/emotions", json={"label": "smirk"})
    assert played.json()["recipe"] == "L12C"
    client.delete(f"/api/sessions/{session}")


def test_a_custom_unit_is_weighted_muscles(client: TestClient) -> None:
    weights = {"zygomatic_major.L": 0.5, "risorius": 0.25}
    ids = []
    for spec in (weights, {"muscles": weights}):
        answer = client.post("/api/rigs", json={"action_units": {"AU90": spec}})
        assert answer.status_code in (200, 201), answer.text
        ids.append(answer.json()["id"])
    assert ids[0] == ids[1]
    unit = next(u for u in answer.json()["action_units"] if u["name"] == "AU90")
    assert unit["muscles"] == weights


@pytest.mark.parametrize(
    "changes",
    [
        {"recipe": {"age": 8}},
        {"recipe": {"skin": "blue"}},
        {"recipe": {"nose": 1}},
        {"base": "paper", "recipe": {"age": 80}},
        {"tissue": {"nonsense": 1}},
        {"tissue": {"damping": "much"}},
        {"tissue": {"damping": 10**400}},
        {"muscles": {"zygomatic_major.L": {"radius": -(10**400)}}},
        {"tissue": {"damping": [[[[[[[[[[1]]]]]]]]]]}},
        {"muscles": {"biceps.L": {"radius": 1}}},
        {"muscles": {"zygomatic_major.L": {"attachment": "here"}}},
        {"muscles": {"zygomatic_major.L": 5}},
        {"muscles": {"zygomatic_major.L": {"radius": 0.001}}},
        {"action_units": {"AU12": 5}},
        {"action_units": {"AU12": {"muscles": [1]}}},
        {"action_units": {"AU12": {"biceps": 1}}},
        {"action_units": {"AU12": {"muscles": {"zygomatic_major": None}}}},
        {"emotions": {"odd": {"recipe": "12C", "synonyms": 5}}},
        {"emotions": {"odd": 7}},
        {"tissue": {"region_laxity": {"chek": 0.5}}},
        {"tissue": {"tissue_depth": [9.0]}},
        {"tissue": {"skin_thickness": {"M1_55": 2.0}}},
        {"tissue_age": "ancient"},
        {"base": "paper", "tissue_age": "old"},
        {"palsy": {"side": "left"}},
        {"palsy": {"side": "up", "grade": "II"}},
        {"relaxed": {"biceps": 0.5}},
        {"relaxed": {"procerus": 2.0}},
        {"base": "nobody"},
        {"name": ""},
    ],
)
def test_changes_that_cannot_be_made_are_refused(
    client: TestClient, changes: dict[str, object]
) -> None:
    answer = client.post("/api/rigs", json={"base": "standard", **changes})
    assert answer.status_code in (404, 422), answer.text
    assert set(answer.json()) <= {"error", "message", "known"}


def test_tissue_is_edited_under_a_live_face(client: TestClient, session: str) -> None:
    client.patch(f"/api/sessions/{session}/controls", json={"action_units": {"AU12": 1}})
    time.sleep(0.5)
    before = client.get(f"/api/sessions/{session}").json()
    tissue = client.get("/api/rigs/standard").json()["tissue"]
    answer = client.patch(
        f"/api/sessions/{session}/tissue", json={"damping": tissue["damping"] * 1.25}
    )
    assert answer.status_code == 200, answer.text
    after = client.get(f"/api/sessions/{session}").json()
    assert after["rig"] == answer.json()["rig"] != before["rig"]
    assert answer.json()["tick"] >= before["tick"]
    assert after["layers"] == before["layers"]
    assert client.get(f"/api/rigs/{after['rig']}").status_code == 200


def test_a_muscle_is_edited_under_a_live_face(client: TestClient, session: str) -> None:
    path = f"/api/sessions/{session}/muscles/zygomatic_major.L"
    answer = client.patch(path, json={"strength": 1.2})
    assert answer.status_code == 200, answer.text
    rig = client.get(f"/api/rigs/{answer.json()['rig']}").json()
    muscle = next(line for line in rig["muscles"] if line["name"] == "zygomatic_major.L")
    assert muscle["strength"] == 1.2
    assert client.patch(path, json={"colour": "red"}).status_code == 422
    unknown = client.patch(f"/api/sessions/{session}/muscles/biceps.L", json={"strength": 1})
    assert unknown.status_code == 404
    assert "zygomatic_major.L" in unknown.json()["known"]


def test_the_cache_folder_is_bounded(tmp_path: Path) -> None:
    settings = settings_in(tmp_path, max_cache_bytes=12_000_000)
    with TestClient(create_app(settings), base_url=LOCAL) as client:
        for number in (1, 2, 4, 5):
            assert client.get(f"/api/rigs/standard/expressions/{number}C.glb").status_code == 200
    sizes = [file.stat().st_size for file in (tmp_path / "cache" / "files").iterdir()]
    assert 0 < sum(sizes) <= 12_000_000


def edited(client: TestClient, session: str, strength: float) -> str:
    path = f"/api/sessions/{session}/muscles/zygomatic_major.L"
    answer = client.patch(path, json={"strength": strength})
    assert answer.status_code == 200, answer.text
    return str(answer.json()["rig"])


def test_live_edits_never_use_up_the_rigs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("service.rigs._PASSING_SECONDS", 0.0)
    with TestClient(create_app(settings_in(tmp_path, max_rigs=4)), base_url=LOCAL) as client:
        kept = client.post("/api/rigs", json={"emotions": {"smirk": "R12C"}}).json()["id"]
        session = client.post("/api/sessions", json={"rig": kept}).json()["id"]
        for step in range(8):
            rig = edited(client, session, 1.0 + step / 10)
            wait_for_row(client, session, rig)
        lines = client.get("/api/rigs").json()["rigs"]
        known = {line["id"] for line in lines if line["id"]}
        assert {kept, rig} <= known
        assert len(known) <= 2 + 4
        assert client.get(f"/api/sessions/{session}").json()["rig"] == rig


def wait_for_row(client: TestClient, session: str, rig: str) -> None:
    """Wait until the store knows that the session is on `rig`."""
    store = parts_of(client).store
    until(lambda: store.session(session).rig == rig)


def test_a_chain_of_rigs_is_read_back_at_once(tmp_path: Path) -> None:
    with TestClient(create_app(settings_in(tmp_path)), base_url=LOCAL) as client:
        session = client.post("/api/sessions", json={}).json()["id"]
        for layer in ("epidermis", "dermis"):
            low = client.get("/api/rigs/standard").json()["tissue"]["stiffness_low"][layer]
            body = {"stiffness_low": {layer: 0.9 * low}}
            assert client.patch(f"/api/sessions/{session}/tissue", json=body).status_code == 200
        for strength in (1.1, 1.2, 1.3):
            last = edited(client, session, strength)
        child = client.post("/api/rigs", json={"base": last, "emotions": {"smirk": "R12C"}}).json()
    with TestClient(create_app(settings_in(tmp_path)), base_url=LOCAL) as client:
        rigs = {line["id"]: line for line in client.get("/api/rigs").json()["rigs"]}
        assert {rigs[last]["base"], rigs[child["id"]]["base"]} == {"standard"}
        again = client.get(f"/api/rigs/{child['id']}").json()
        assert again == child
        assert client.get(f"/api/sessions/{session}").json()["rig"] == last


def test_a_recipe_is_a_rig(client: TestClient) -> None:
    first = client.post("/api/rigs", json={"recipe": {"age": 60, "skin": "dark"}})
    assert first.status_code == 201, first.text
    again = client.post("/api/rigs", json={"recipe": {"skin": 1.0, "age": 60.0}})
    assert (again.status_code, again.json()["id"]) == (200, first.json()["id"])
    assert first.json()["recipe"]["age"] == 60.0
    edited = client.post(
        "/api/rigs", json={"recipe": {"age": 60, "skin": "dark"}, "tissue": {"damping": 50}}
    ).json()
    assert edited["id"] != first.json()["id"]
    assert edited["tissue"]["pretension"] == first.json()["tissue"]["pretension"]


def test_a_recipe_of_a_recipe_adds_up(client: TestClient) -> None:
    old = client.post("/api/rigs", json={"recipe": {"age": 70}}).json()
    both = client.post("/api/rigs", json={"base": old["id"], "recipe": {"sex": "female"}}).json()
    at_once = client.post("/api/rigs", json={"recipe": {"age": 70, "sex": "female"}}).json()
    assert both["id"] == at_once["id"]


def test_an_unknown_attribute_comes_with_the_known_ones(client: TestClient) -> None:
    answer = client.post("/api/rigs", json={"recipe": {"nose": 1}})
    assert answer.status_code == 422
    assert "nose_width" in answer.json()["known"]
    word = client.post("/api/rigs", json={"recipe": {"skin": "blue"}})
    assert "very_light" in word.json()["known"]


def test_people_are_rigs(client: TestClient) -> None:
    everybody = client.get("/api/people").json()["people"]
    assert len(everybody) == 12
    listed = {line["name"] for line in client.get("/api/rigs").json()["rigs"]}
    assert {person["name"] for person in everybody} <= listed
    rig = client.get("/api/rigs/amara").json()
    assert rig["recipe"] == everybody[0]["recipe"]
    session = client.post("/api/sessions", json={"rig": "amara"})
    assert session.json()["rig"] == rig["id"]
    client.delete(f"/api/sessions/{session.json()['id']}")


def test_a_level_of_detail_has_its_own_tag(client: TestClient) -> None:
    path = "/api/rigs/standard/surface.glb"
    answers = [client.get(path, params={"level": level}) for level in ("low", "high")]
    tags = [answer.headers["ETag"] for answer in answers]
    assert tags[0] != tags[1] == client.get(path).headers["ETag"]
    assert len(answers[0].content) < len(answers[1].content)
    refused = client.get(path, params={"level": "huge"})
    assert refused.status_code == 422
    assert refused.json()["known"] == ["high", "low", "medium"]


def test_an_id_of_an_older_engine_is_found(tmp_path: Path) -> None:
    with TestClient(create_app(settings_in(tmp_path)), base_url=LOCAL) as client:
        store = parts_of(client).store
        store.name_rig("0123456789abcdef", "standard")
        store.add_rig("fedcba9876543210", base="standard", changes={"tissue": {"damping": 50}})
        standard = client.get("/api/rigs/standard").json()
        assert client.get("/api/rigs/0123456789abcdef").json() == standard
        derived = client.get("/api/rigs/fedcba9876543210").json()
        assert client.get(f"/api/rigs/{derived['id']}").json() == derived


def test_conditions_are_kept_as_what_they_come_to(client: TestClient) -> None:
    weak = {"palsy": {"side": "left", "grade": "IV"}, "tissue_age": "old"}
    first = client.post("/api/rigs", json=weak)
    assert first.status_code == 201, first.text
    assert client.post("/api/rigs", json=weak).json()["id"] == first.json()["id"]
    gains = {m["name"]: m["gain"] for m in first.json()["muscles"]}
    assert gains["zygomatic_major.L"] == [0.4, 1.0]
    relaxed = {"base": first.json()["id"], "relaxed": {"procerus": {"left": 0.5}}}
    second = client.post("/api/rigs", json=relaxed)
    assert second.status_code == 201, second.text
    after = second.json()
    assert after["tissue"]["muscle_strength"] == first.json()["tissue"]["muscle_strength"] < 1.0
    assert {m["name"]: m["gain"] for m in after["muscles"]}["zygomatic_major.L"] == [0.4, 1.0]


def test_a_thickness_map_may_come_by_node(client: TestClient) -> None:
    count = client.get("/api/rigs/standard").json()["mesh"]["tissue_nodes"] // 3
    answer = client.post("/api/rigs", json={"tissue": {"skin_thickness": [2.0] * count}})
    assert answer.status_code == 201, answer.text
    assert answer.json()["tissue"]["skin_thickness"] == [2.0] * count
