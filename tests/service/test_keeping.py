"""What is answered is kept: commits come before answers, and many commands share one."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from conftest import parts_of, until
from starlette.testclient import TestClient

from service.errors import Busy
from service.keeping import Keeper
from service.store import Store


@dataclass(eq=False)
class Counter:
    """A session that holds a number."""

    id: str
    value: int = 0
    unsaved: bool = False

    def to_row(self, tick: int) -> dict[str, Any]:
        held = [self.value]
        return {"id": self.id, "rig": "standard", "held": held, "used": float(tick), "life": None}

    def kept(self, row: Mapping[str, Any]) -> None:
        assert row["id"] == self.id


def kept(store: Store, session: str) -> list[Any]:
    row = store.session(session)
    assert row is not None
    return row.held


@pytest.fixture
def store(tmp_path: Path) -> Store:
    """A store with the sessions 0 to 9."""
    store = Store(f"sqlite:///{tmp_path / 'kept.sqlite3'}")
    for number in range(10):
        store.add_session(str(number), rig="standard", model={})
    return store


Rows = Sequence[Mapping[str, Any]]


def counting(store: Store, monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Return a list that grows by the number of rows of each commit."""
    commits: list[int] = []
    keep: Callable[[Rows], None] = store.keep_sessions

    def counted(rows: Rows) -> None:
        commits.append(len(rows))
        keep(rows)

    monkeypatch.setattr(store, "keep_sessions", counted)
    return commits


def test_many_who_wait_share_few_commits(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    commits = counting(store, monkeypatch)
    sessions = [Counter(str(number)) for number in range(10)]

    async def write(keeper: Keeper, session: Counter, value: int) -> None:
        session.value = value
        await keeper.keep(session, value)
        assert kept(store, session.id)[0] >= value  # What has been answered is there.

    async def all_at_once() -> None:
        keeper = Keeper(store)
        writes = [write(keeper, each, value) for value in range(1, 21) for each in sessions]
        await asyncio.gather(*writes)

    asyncio.run(all_at_once())
    assert len(commits) <= 3
    assert all(kept(store, each.id) == [20] for each in sessions)
    store.close()


def test_one_after_another_each_has_its_commit(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    commits = counting(store, monkeypatch)
    session = Counter("3")

    async def by_turns() -> None:
        keeper = Keeper(store)
        for value in range(5):
            session.value = value
            await keeper.keep(session, value)
            assert kept(store, "3") == [value]

    asyncio.run(by_turns())
    assert commits == [1] * 5
    store.close()


def test_a_store_that_fails_is_told_to_all_and_tried_again(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    session, other = Counter("1", 5), Counter("2", 6)

    def locked(_rows: object) -> None:
        raise OSError("the database is locked")

    async def fail_then_keep() -> None:
        keeper = Keeper(store)
        with monkeypatch.context() as patch:
            patch.setattr(store, "keep_sessions", locked)
            both = await asyncio.gather(
                keeper.keep(session, 1), keeper.keep(other, 1), return_exceptions=True
            )
        assert [type(error) for error in both] == [Busy, Busy]
        assert session.unsaved
        assert other.unsaved
        await keeper.keep(session, 2)
        assert not session.unsaved

    asyncio.run(fail_then_keep())
    assert kept(store, "1") == [5]
    store.close()


def test_one_who_gives_up_leaves_the_others_theirs(store: Store) -> None:
    async def give_up() -> None:
        keeper = Keeper(store)
        first = asyncio.create_task(keeper.keep(Counter("1", 1), 1))
        second = asyncio.create_task(keeper.keep(Counter("2", 2), 1))
        await asyncio.sleep(0)
        first.cancel()
        await second
        with pytest.raises(asyncio.CancelledError):
            await first

    asyncio.run(give_up())
    assert kept(store, "1") == [1]
    assert kept(store, "2") == [2]
    store.close()


def held(client: TestClient, session: str) -> set[tuple[str, str]]:
    """Return layer and owner of what the database has of a session."""
    row = parts_of(client).store.session(session)
    assert row is not None
    return {(each["layer"], each.get("owner", "anyone")) for each in row.held}


def test_what_is_answered_is_in_the_database(client: TestClient, session: str) -> None:
    path = f"/api/sessions/{session}"
    client.patch(f"{path}/controls", json={"action_units": {"AU12": 0.5}})
    assert held(client, session) == {("puppet", "anyone")}
    client.post(f"{path}/emotions", json={"label": "joy", "owner": "agent", "ttl": 100})
    assert held(client, session) == {("puppet", "anyone"), ("emotion", "agent")}
    rig = client.patch(f"{path}/muscles/risorius.L", json={"strength": 1.1}).json()["rig"]
    row = parts_of(client).store.session(session)
    assert row is not None
    assert row.rig == rig
    client.put(f"{path}/controls", json={})
    assert held(client, session) == {("emotion", "agent")}


def test_what_is_left_of_a_lease_is_kept_each_second(client: TestClient, session: str) -> None:
    def left() -> float:
        row = parts_of(client).store.session(session)
        assert row is not None
        return float(row.held[0]["hold"])

    body = {"action_units": {"AU12": 0.5}, "ttl": 100}
    client.patch(f"/api/sessions/{session}/controls", json=body)
    assert left() == pytest.approx(100, abs=0.1)
    until(lambda: left() < 99.5)


def test_a_speech_under_way_is_not_kept(client: TestClient, session: str) -> None:
    path = f"/api/sessions/{session}"
    visemes = [{"viseme": "aa", "duration": 30}, {"viseme": "PP", "duration": 1}]
    client.patch(f"{path}/controls", json={"visemes": {"ou": 0.5}, "owner": "voice"})
    assert held(client, session) == {("speech", "voice")}
    client.post(f"{path}/speech", json={"visemes": visemes, "owner": "voice"})
    assert held(client, session) == set()
    until(lambda: "speech" in client.get(path).json()["layers"])
    client.patch(f"{path}/controls", json={"action_units": {"AU1": 0.5}})
    assert held(client, session) == {("puppet", "anyone")}
    client.delete(f"{path}/speech", params={"owner": "voice"})
    until(lambda: "speech" not in client.get(path).json()["layers"])
    client.patch(f"{path}/controls", json={"visemes": {"ou": 0.5}, "owner": "voice"})
    until(lambda: held(client, session) == {("puppet", "anyone"), ("speech", "voice")})


def test_a_command_that_cannot_be_kept_is_not_answered_as_if(
    client: TestClient, session: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_rows: object) -> None:
        raise OSError("the disk is full")

    path = f"/api/sessions/{session}/controls"
    with monkeypatch.context() as patch:
        patch.setattr(parts_of(client).store, "keep_sessions", full)
        answer = client.patch(path, json={"action_units": {"AU12": 0.5}})
    assert answer.status_code == 503
    assert answer.json()["error"] == "not_kept"
    assert answer.headers["Retry-After"] == "1"
    assert client.patch(path, json={"action_units": {"AU12": 0.5}}).status_code == 200
