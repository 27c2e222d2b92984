"""Rigs by name and id: found in one step, refused before the work, and admitted one by one."""

from __future__ import annotations

import asyncio
import shutil
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from conftest import LOCAL, parts_of, settings_in
from sqlalchemy import text
from starlette.testclient import TestClient

import service.rigs
from engine import Rig
from service.app import create_app
from service.errors import Busy, NotFound
from service.rigs import Rigs
from service.store import Store


@contextmanager
def rigs_in(folder: Path, *, limit: int = 100) -> Iterator[tuple[Rigs, Store]]:
    store = Store(f"sqlite:///{folder / 'rigs.sqlite3'}")
    rigs = Rigs(store, cache_dir=folder, cache_bytes=0, limit=limit)
    try:
        yield rigs, store
    finally:
        rigs.close()
        store.close()


@pytest.fixture
def derived(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """What was derived: the heavy work."""
    calls: list[Any] = []
    derive = service.rigs.derived

    def counted(base: Rig, changes: Any) -> Rig:
        calls.append(changes)
        return derive(base, changes)

    monkeypatch.setattr(service.rigs, "derived", counted)
    return calls


A, B = {"tissue": {"damping": 50}}, {"tissue": {"damping": 51}}


def test_a_client_over_the_limit_is_refused_before_the_work(
    tmp_path: Path, derived: list[Any]
) -> None:
    async def scene(rigs: Rigs) -> None:
        base = await rigs.get("standard")
        await rigs.derive(base, A)
        with pytest.raises(Busy, match="at most 1 rigs"):
            await rigs.derive(base, B)

    with rigs_in(tmp_path, limit=1) as (rigs, _):
        asyncio.run(scene(rigs))
    assert derived == [A]


@pytest.mark.parametrize("changes", [A, {"recipe": {"age": 60, "skin": "dark"}}])
def test_what_is_kept_is_given_over_the_limit_too(tmp_path: Path, changes: dict[str, Any]) -> None:
    async def derive(rigs: Rigs) -> tuple[str, bool]:
        rig, new = await rigs.derive(await rigs.get("standard"), changes)
        return rig.id, new

    with rigs_in(tmp_path, limit=1) as (rigs, _):
        first, new = asyncio.run(derive(rigs))
        assert new
    with rigs_in(tmp_path, limit=1) as (rigs, _):
        assert asyncio.run(derive(rigs)) == (first, False)


def test_only_so_many_are_derived_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(service.rigs, "_DERIVED_AT_ONCE", 2)
    go, derive = threading.Event(), service.rigs.derived
    monkeypatch.setattr(service.rigs, "derived", lambda *given: go.wait(20) and derive(*given))

    async def scene(rigs: Rigs) -> list[Any]:
        base = await rigs.get("standard")
        changes = [{"tissue": {"damping": 50 + number}} for number in (0, 1, 0, 2)]
        tasks = [asyncio.create_task(rigs.derive(base, change)) for change in changes]
        await asyncio.sleep(0.05)
        go.set()
        results = await asyncio.gather(*tasks, return_exceptions=True)
        await rigs.derive(base, changes[-1])
        return results

    with rigs_in(tmp_path) as (rigs, _):
        results = asyncio.run(scene(rigs))
    # The third asks for what is being derived already; the fourth is one too many.
    assert isinstance(results[3], Busy)
    assert int(results[3].headers["Retry-After"]) > 0
    assert sorted(new for _, new in results[:3]) == [False, True, True]


def test_a_place_is_promised_once(tmp_path: Path, derived: list[Any]) -> None:
    async def scene(rigs: Rigs) -> list[Any]:
        base = await rigs.get("standard")
        return await asyncio.gather(
            *(rigs.derive(base, changes) for changes in (A, B)), return_exceptions=True
        )

    with rigs_in(tmp_path, limit=1) as (rigs, store):
        first, second = asyncio.run(scene(rigs))
        assert first[1]
        assert isinstance(second, Busy)
        assert store.rig_count() == 1
    assert derived == [A]


OLD = ("0" * 16, "1" * 16, "2" * 16)


def circle_of_names(store: Store) -> None:
    store.name_rig(OLD[0], OLD[1])
    store.name_rig(OLD[1], OLD[0])


def circle_of_rows(store: Store) -> None:
    store.add_rig(OLD[0], base=OLD[1], changes=A)
    store.add_rig(OLD[1], base=OLD[0], changes=B)


def nothing_below(store: Store) -> None:
    store.add_rig(OLD[0], base=OLD[1], changes=A)


def name_of_itself(store: Store) -> None:
    store.name_rig(OLD[0], OLD[0])


@pytest.mark.parametrize("spoil", [circle_of_names, circle_of_rows, nothing_below, name_of_itself])
def test_a_lookup_always_ends(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, spoil: Callable[[Store], None]
) -> None:
    monkeypatch.setattr(service.rigs, "people", dict)
    with rigs_in(tmp_path) as (rigs, store):
        spoil(store)
        with pytest.raises(NotFound):
            asyncio.run(rigs.get(OLD[0]))


def test_rows_on_rows_of_an_older_service_are_read(tmp_path: Path) -> None:
    async def scene(rigs: Rigs) -> Rig:
        return await rigs.get(OLD[2])

    with rigs_in(tmp_path) as (rigs, store):
        store.name_rig(OLD[0], "standard")
        store.add_rig(OLD[1], base=OLD[0], changes={"tissue": {"damping": 60, "ligament": 4.0}})
        store.add_rig(OLD[2], base=OLD[1], changes=A)
        parameters = asyncio.run(scene(rigs)).parameters
    assert (parameters.damping, parameters.ligament) == (50.0, 4.0)


def test_a_person_is_found_by_an_id_that_this_store_has_not_seen(tmp_path: Path) -> None:
    with TestClient(create_app(settings_in(tmp_path)), base_url=LOCAL) as client:
        rig = client.get("/api/rigs/amara").json()["id"]
        session = client.post("/api/sessions", json={"rig": "amara"}).json()["id"]
        store = parts_of(client).store
        with store.engine.begin() as connection:
            connection.execute(text("DELETE FROM named_rigs"))
    shutil.rmtree(tmp_path / "cache", ignore_errors=True)
    with TestClient(create_app(settings_in(tmp_path)), base_url=LOCAL) as client:
        assert client.get(f"/api/sessions/{session}").json()["rig"] == rig
        assert client.get(f"/api/rigs/{rig}").json()["name"] == "amara"
