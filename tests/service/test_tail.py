"""The tail of a timeline: bounded, exact where it begins, and the same out of the store."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path

import pytest
from test_recording import MODEL, NOW, RIG, commands, live, played, told

from engine import Keyframe, Writers
from service import tail as tails
from service.recording import LEAD_SECONDS, recorded_clip
from service.store import Store
from service.tail import Command, Resumed, Tail, follow

MOOD = Keyframe(layer="mood", owner="a", action_units={"AU4": 0.5})


def holding(commands: Iterable[Command]) -> Writers:
    writers = Writers(RIG)
    for command in commands:
        follow(writers, command)
    return writers


def busy(count: int) -> list[Command]:
    """Return commands, one a tick: a mood that stays, a lease, and an intensity that goes on."""
    lease = Keyframe(owner="c", action_units={"AU1": 0.5}, ttl=count / 120)
    moves = [
        Keyframe(owner="b", action_units={"AU12": (n % 100) / 100, "L4": 0.2}) for n in range(count)
    ]
    return [
        Command(0, MOOD),
        Command(0, lease),
        *(Command(n, each) for n, each in enumerate(moves)),
    ]


@pytest.fixture
def store(tmp_path: Path) -> Store:
    """A store with one session."""
    store = Store(f"sqlite:///{tmp_path / 'kept.sqlite3'}")
    store.add_session("s", rig="standard", model={})
    return store


def keep(store: Store, tail: Tail, tick: int) -> None:
    """Commit what the store does not have, as a service does."""
    piece = tail.piece()
    row = {"id": "s", "rig": "standard", "held": [], "used": 0.0, "life": None}
    store.keep_sessions([{**row, "tick": tick + tail.elapsed, "tail": piece}])
    if piece is not None:
        tail.kept(piece)


def again(store: Store) -> Tail:
    """Return what a service that starts anew reads."""
    row = store.session("s")
    assert row is not None
    pieces = store.tail("s")
    assert json.loads(json.dumps(pieces)) == [list(piece) for piece in pieces]
    before = row.before or ()
    return Tail.restored(RIG, pieces, elapsed=row.tick, begins=row.begins, before=before)


def test_it_is_bounded_and_knows_what_was_held_where_it_begins(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(tails, "MOST_KEPT", 50)
    every = busy(400)
    tail = told(every)
    assert len(tail.commands) <= 50
    assert not tail.whole
    ahead = [each for each in every if each.tick <= tail.begins]
    assert tail.before.report(tail.begins) == holding(ahead).report(tail.begins)
    assert [*tail.commands] == every[len(ahead) :]
    clip = recorded_clip(tail, RIG, MODEL, now=400, last=60.0, fps=30)
    assert clip.start == LEAD_SECONDS
    assert "mood" in {keyframe.layer for keyframe in clip.timeline}


def test_what_is_told_late_stands_where_its_tick_is() -> None:
    tail = told([Command(5, MOOD), Command(9, MOOD)])
    tail.add(Command(7, MOOD, idle=True))
    assert [each.tick for each in tail.commands] == [5, 7, 9]


def test_the_store_gives_back_what_it_was_given(store: Store) -> None:
    tail = Tail(RIG)
    for each in commands():
        tail.add(each)
        keep(store, tail, each.tick)
    keep(store, tail, NOW)
    assert tail.piece() is None
    assert len(store.tail("s")) == len(tail.commands)
    back = again(store)
    assert [(each.tick + NOW, each.command) for each in back.commands] == [
        (each.tick, each.command) for each in tail.commands
    ]
    assert back.whole
    assert back.begins == -NOW
    clip = recorded_clip(tail, RIG, MODEL, now=NOW, last=60.0, fps=60)
    assert recorded_clip(back, RIG, MODEL, now=0, last=60.0, fps=60) == clip
    store.remove_session("s")
    assert store.tail("s") == []
    keep(store, told(commands()), NOW)  # A late commit brings nothing of it back.
    assert store.tail("s") == []
    store.close()


def test_the_store_forgets_what_falls_off(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tails, "MOST_KEPT", 60)
    monkeypatch.setattr(tails, "_CUT", 20)
    tail = Tail(RIG)
    for each in busy(400):
        tail.add(each)
        if each.tick % 7 == 0:
            keep(store, tail, each.tick)
    keep(store, tail, 400)
    assert sum(len(lines) for _, lines in store.tail("s")) < 60 + 20 + 7 + 2
    back = again(store)
    assert not back.whole
    assert back.begins + 400 <= tail.begins
    held = holding([Command(back.begins, Resumed(back.before.keyframes(back.begins)))])
    for each in back.commands:
        follow(held, each)
    assert set(held.report(0)) == {"mood", "puppet"}
    assert held.units("mood") == {"AU4": 0.5}
    assert held.units("puppet") == {"AU12": 0.99, "L4": 0.2}
    store.close()


def test_a_commit_that_fails_takes_nothing_away(store: Store) -> None:
    tail = told(commands())
    assert tail.piece() is not None  # It is made, and never comes to the store.
    keep(store, tail, NOW)
    assert len(again(store).commands) == len(tail.commands)
    store.close()


def test_a_recording_goes_on_through_a_restart(store: Store) -> None:
    tail = told(commands())
    tail.add(Command(NOW - 1, Keyframe(layer="speech", owner="e", jaw={"pitch": 9.0})))
    keep(store, tail, NOW)
    back = again(store)
    mood = [each for each in holding(commands()).keyframes(NOW) if each.owner == "a"]
    back.add(Command(0, Resumed(mood)))
    back.add(Command(30, Keyframe(owner="d", action_units={"AU12": 1.0}, fade=0.2)))
    keep(store, back, 60)
    for each in (back, again(store)):
        now = 60 if each is back else 0
        clip = recorded_clip(each, RIG, MODEL, now=now, last=600.0, fps=60)
        assert clip.duration == (NOW + 60) / 60
        moved = played(clip)
        assert (moved.displacements[: NOW - 1] == live(NOW).displacements[: NOW - 1]).all()
        after = [k for k in clip.timeline if k.time == NOW / 60]
        # Whoever held anything that did not outlive the service lets go, and the mood stays.
        assert {k.owner for k in after if k.replace} == {"a", "e"}
        assert [k.owner for k in after if not k.replace] == ["a"]
    store.close()
