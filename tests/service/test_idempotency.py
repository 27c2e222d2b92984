"""A POST with an Idempotency-Key can be sent again."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import pytest
from starlette.testclient import TestClient


def post(client: TestClient, key: str, body: object, path: str = "/api/sessions"):
    return client.post(path, json=body, headers={"Idempotency-Key": key})


def test_a_retry_gets_the_first_answer(client: TestClient) -> None:
    first = post(client, "one", {"rig": "standard"})
    again = post(client, "one", {"rig": "standard"})
    assert first.status_code == again.status_code == 201
    assert again.json() == first.json()
    assert again.headers["Location"] == first.headers["Location"]
    other = post(client, "two", {"rig": "standard"})
    assert other.json()["id"] != first.json()["id"]
    for answer in (first, other):
        client.delete(f"/api/sessions/{answer.json()['id']}")


def test_a_key_is_for_one_request(client: TestClient) -> None:
    first = post(client, "three", {"rig": "standard"})
    answer = post(client, "three", {"rig": "paper"})
    assert answer.status_code == 409
    assert answer.json()["error"] == "idempotency_conflict"
    client.delete(f"/api/sessions/{first.json()['id']}")


def test_retries_at_the_same_time_make_one_session(client: TestClient) -> None:
    with ThreadPoolExecutor(4) as pool:
        answers = list(pool.map(lambda _: post(client, "four", {}), range(4)))
    assert len({answer.json()["id"] for answer in answers}) == 1
    client.delete(f"/api/sessions/{answers[0].json()['id']}")


def test_a_refusal_is_repeated_too(client: TestClient) -> None:
    assert post(client, "five", {"rig": "nobody"}).status_code == 404
    assert post(client, "five", {"rig": "nobody"}).status_code == 404


@pytest.mark.parametrize("key", ["", "k" * 256])
def test_a_key_has_a_length(client: TestClient, key: str) -> None:
    assert post(client, key, {}).status_code == 422
