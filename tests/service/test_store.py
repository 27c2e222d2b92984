"""The store: what is kept, and what is forgotten."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy import text

from service.store import Store


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    """A store in a file, in a folder that is not there yet."""
    kept = Store(f"sqlite:///{tmp_path / 'new' / 'risorius.sqlite3'}")
    yield kept
    kept.close()


def test_the_file_is_set_up_for_many_readers(store: Store) -> None:
    with store.engine.connect() as connection:
        assert connection.execute(text("PRAGMA journal_mode")).scalar() == "wal"
        assert connection.execute(text("PRAGMA foreign_keys")).scalar() == 1
        assert connection.execute(text("PRAGMA busy_timeout")).scalar() == 5000


def test_idle_sessions_are_forgotten_but_live_ones(store: Store) -> None:
    for name, used in (("old", 10.0), ("old-but-live", 10.0), ("new", 30.0)):
        store.add_session(name, rig="standard", model={})
        store.keep_sessions(
            [{"id": name, "rig": "standard", "held": [], "used": used, "life": None}]
        )
    store.remove_idle_sessions(20.0, but=["old-but-live"])
    assert {row.id for row in store.sessions()} == {"old-but-live", "new"}


def test_the_life_of_a_session_is_kept_with_it(store: Store) -> None:
    def life(name: str) -> object:
        row = store.session(name)
        return row.life if row else "gone"

    store.add_session("a", rig="standard", model={}, life={"seed": 1})
    store.add_session("b", rig="standard", model={})
    assert (life("a"), life("b")) == ({"seed": 1}, None)
    rest = {"rig": "standard", "held": [], "used": 1.0}
    store.keep_sessions([{"id": "a", **rest, "life": None}, {"id": "b", **rest, "life": {"x": 2}}])
    assert (life("a"), life("b")) == (None, {"x": 2})


def test_a_rig_is_kept_once(store: Store) -> None:
    store.add_rig("a", base="standard", changes={"tissue": {"damping": 1}})
    store.add_rig("a", base="paper", changes={})
    row = store.rig("a")
    assert row is not None
    assert row.base == "standard"
    assert [line.id for line in store.rigs()] == ["a"]


def test_a_clip_is_kept_through_its_life(store: Store) -> None:
    store.add_clip("c", rig="standard", fps=30, request={"timeline": []})
    store.keep_clip("c", status="running")
    assert store.clip("c").finished is None  # type: ignore[union-attr]
    store.keep_clip("c", status="done", report={"frames": 3})
    row = store.clip("c")
    assert row is not None
    assert (row.status, row.report) == ("done", {"frames": 3})
    assert row.finished is not None
    assert store.clip_count() == 1
    store.remove_clip("c")
    assert store.clip("c") is None


def test_a_store_in_memory_needs_no_file() -> None:
    store = Store("sqlite://")
    store.add_session("s", rig="standard", model={})
    assert store.session("s") is not None
    store.close()
