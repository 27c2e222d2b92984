"""The rigs that sessions and clips use: built in, or derived and kept in the store."""

from __future__ import annotations

import asyncio
import copy
import hashlib
import json
import re
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import Any

import structlog

from engine import (
    BUILTIN_RIGS,
    ENGINE_HASH,
    LEVELS,
    Cancelled,
    EngineError,
    Recipe,
    Rig,
    UnknownName,
    arkit_table,
    arkit_to_glb,
    builtin_rig,
    keep,
    people,
    read_kept,
    rig_to_glb,
    surface_to_glb,
    texture_names,
    textures_of,
    tissue_to_glb,
)

from .access import EVERYTHING, Access
from .baking import baked_apart
from .bystanders import Bystanders
from .deriving import Steps, derived, derived_by_steps, in_plain_changes
from .errors import Busy, NotFound, refused_by_engine
from .explaining import did_you_mean
from .latest_first import LatestFirst
from .priority import AWAITED, background_pool
from .shelf import Shelf
from .store import Store

_LOG = structlog.get_logger("rigs")
_RIGS_IN_MEMORY = 64
_FILES_IN_MEMORY = 16
_TEXTURED_IN_MEMORY = 4
_WAITING_BAKES = 8
"""People whose maps may wait to be baked, about ten seconds each; who is left out is baked when
somebody asks for the maps again."""
_DERIVED_AT_ONCE = 16
"""Rigs that may be derived or wait for it: a new person takes a second or two."""
_PASSING_SECONDS = 60.0
_ID = re.compile("[0-9a-f]{16}")


FULL = "high"
"""The level of detail of what is asked for without one."""
UNITS = "facs"
"""The names of what is asked for with action units as morph targets."""
TARGETS = {UNITS: rig_to_glb, "arkit": arkit_to_glb}
"""What writes the rest head with morph targets, by their names."""
_TITLES = {
    "standard": "the built-in head",
    "paper": "the paper's own mesh and constants, for comparison",
}


def tag_of(rig: Rig, level: str) -> str:
    """Return what names a rig's file at a level of detail.

    Raises:
        Unprocessable: If there is no such level.
    """
    if level not in LEVELS:
        raise refused_by_engine(UnknownName("level of detail", level, LEVELS))
    return rig.id if level == FULL else f"{rig.id}-{level}"


def tissue_tag(rig: Rig) -> str:
    """Return what names a rig's tissue file in its present form, the one with `_JAW`."""
    return f"{rig.id}-riding"


def export_tag(rig: Rig, level: str, *, textured: bool) -> str:
    """Return what names a file of a rig that embeds its maps, or leaves them out.

    Raises:
        Unprocessable: If there is no such level.
    """
    tag = tag_of(rig, level)
    return tag if textured or not texture_names(rig) else f"{tag}-bare"


def targets_tag(rig: Rig, level: str, names: str, *, textured: bool) -> str:
    """Return what names a file of a rig with morph targets.

    Raises:
        Unprocessable: If there is no such level, or nothing has those names.
    """
    tag = export_tag(rig, level, textured=textured)
    if names not in TARGETS:
        raise refused_by_engine(UnknownName("vocabulary", names, TARGETS))
    return tag if names == UNITS else f"{tag}-{names}-{arkit_table().version}"


def _person_key(rig: Rig) -> str:
    """Return what names a rig's textures: edits of tissue and muscles leave them as they are."""
    return repr(rig.recipe) if rig.recipe is not None else rig.id


def _named() -> tuple[str, ...]:
    """Return the names of the rigs that come with the engine."""
    return (*BUILTIN_RIGS, *people())


class Rigs:
    """Rigs by name or id, and the GLB files made from them.

    Ids are hashes of what a rig is: who knows one may read it. `seen_by` lists to each key only the
    derived rigs that it made.
    """

    def __init__(
        self,
        store: Store,
        *,
        cache_dir: Path,
        cache_bytes: int,
        limit: int,
        bystanders: Bystanders | None = None,
    ) -> None:
        self._access = EVERYTHING
        self._bake = partial(baked_apart, bystanders=bystanders)
        self._store = store
        self._cache_dir = cache_dir
        self._cache_bytes = cache_bytes
        self._limit = limit
        self._pool = background_pool(1, "rigs", steps=AWAITED)
        self._files_pool = background_pool(1, "files", steps=AWAITED)
        self._rigs: Shelf[Rig] = Shelf(_RIGS_IN_MEMORY, self._pool)
        self._files: Shelf[bytes] = Shelf(_FILES_IN_MEMORY, self._files_pool)
        # A pool of its own: a bake takes seconds, and files must not wait behind it.
        self._bakery = LatestFirst("textures", most=_WAITING_BAKES)
        self._closing = threading.Event()
        self._textures: Shelf[Mapping[str, bytes]] = Shelf(_TEXTURED_IN_MEMORY, self._bakery)
        self._names: dict[str, str] = {}
        self._deriving: list[str] = []

    def seen_by(self, access: Access) -> Rigs:
        """Return the same rigs as somebody sees them."""
        seen = copy.copy(self)
        seen._access = access
        return seen

    def close(self) -> None:
        """Stop the pools; a bake ends with the map that it is at."""
        self._closing.set()
        self._pool.shutdown(wait=True, cancel_futures=True)
        self._files_pool.shutdown(wait=True, cancel_futures=True)
        self._bakery.shutdown(wait=True, cancel_futures=True)

    async def get(self, name: str) -> Rig:
        """Return the rig of that name (`standard`, `amara`) or id, also one that it had before.

        Raises:
            NotFound: If there is none.
        """
        known = self._known(name) or await self._known_when_built(name)
        if known is None:
            raise self._unknown(name)
        if known in _named():
            return await self._built_in(known)
        root, steps = await self._made_from(known)
        base = await self._built_in(root)
        rig = await self._rigs.get(known, lambda: derived_by_steps(base, steps))
        if rig.id not in self._names and rig.id != known:  # It was derived by another engine.
            self._store.name_rig(rig.id, known)
            self._names[rig.id] = known
        return rig

    async def made_from(self, name: str) -> tuple[str, Steps]:
        """Return the named rig that a rig comes from, and what was changed, step by step.

        Args:
            name: As `get` takes it.

        Raises:
            NotFound: If there is none.
        """
        known = self._known(name) or await self._known_when_built(name)
        if known is None:
            raise self._unknown(name)
        return await self._made_from(known)

    async def derive(
        self, base: Rig, changes: Mapping[str, Any], *, passing: bool = False
    ) -> tuple[Rig, bool]:
        """Return the rig that `changes` make of `base`, and whether it is new here.

        Args:
            base: What is changed.
            changes: By `tissue`, `muscles`, `action_units`, `emotions`, `name`, and conditions
                (`tissue_age`, `palsy`, `relaxed`), which are kept as what they come to.
            passing: Whether it is one step of a live edit: it then makes room for others once no
                session and no clip is on it.

        Raises:
            Unprocessable: If a name is unknown or a value cannot be used.
            Busy: If no more rigs can be kept, or too many are being derived.
        """
        changes = {key: value for key, value in changes.items() if value is not None}
        changes = in_plain_changes(base, changes)
        # A row says how its rig comes from one that has a name, so that none depends on another
        # row, nor on the ids that this engine gives.
        root = self._known(base.id) or base.id
        all_changes: Mapping[str, Any] = changes
        before = self._store.rig(root)
        if before is not None:
            root, all_changes = before.base, merged_changes(before.changes, changes)
        key = _key(base.id, changes)
        kept = None
        if key not in self._rigs and self._is_full():
            kept = self._kept(root, _in_full(all_changes, _recipe_of(base, changes)))
        if kept is not None:
            rig = await self.get(kept)
        else:
            with self._admitted(key):
                rig = await self._rigs.get(key, lambda: derived(base, changes))
        known = self._known(rig.id)
        if known is not None:
            if not passing:
                self._store.keep_rig(known)
            self._note_maker(known)
            return rig, False
        self._make_room()
        all_changes = _in_full(all_changes, rig.recipe)
        self._store.add_rig(rig.id, base=root, changes=all_changes, passing=passing)
        self._note_maker(rig.id)
        self._rigs.put(rig.id, rig)
        return rig, True

    async def lines(self) -> list[dict[str, object]]:
        """Return one line for each rig."""
        lines: list[dict[str, object]] = []
        for name in BUILTIN_RIGS:
            rig = await self._built_in(name)
            lines.append({"id": rig.id, "name": name, "base": None, "title": _TITLES[name]})
        ids = {name: rig_id for rig_id, name in self._names.items()}
        for person in people().values():  # Named without being built: that takes half a second.
            lines.append(
                {
                    "id": ids.get(person.name),
                    "name": person.name,
                    "base": None,
                    "title": person.title,
                }
            )
        for row in self._store.rigs(self._access.key):
            name = str(row.changes.get("name") or row.id)
            lines.append({"id": row.id, "name": name, "base": row.base})
        return lines

    async def glb(
        self, rig: Rig, level: str = FULL, *, textured: bool = True, names: str = UNITS
    ) -> bytes:
        """Return the rest head with morph targets, of the `names` that `TARGETS` has."""
        write = TARGETS[names]
        return await self.export(
            rig,
            f"rig-{targets_tag(rig, level, names, textured=textured)}",
            lambda maps: write(rig.at_level(level), textures=maps),
            textured=textured,
        )

    async def surface(self, rig: Rig, level: str = FULL) -> bytes:
        """Return the tissue surface and its map to the drawn surface."""
        key = f"surface-{tag_of(rig, level)}"
        return await self._file(key, lambda: surface_to_glb(rig.at_level(level)))

    async def tissue(self, rig: Rig) -> bytes:
        """Return what lies under its skin: sheets of nodes, and springs."""
        return await self._file(f"tissue-{rig.id}", lambda: tissue_to_glb(rig))

    def texture_names(self, rig: Rig) -> tuple[str, ...]:
        """Return the files of a rig's textures; none for a head without any."""
        return texture_names(rig)

    def texture_tag(self, rig: Rig, file: str) -> str:
        """Return what names one of a rig's textures as this engine bakes it."""
        return f"{rig.id}-{file}"

    async def textures(self, rig: Rig) -> Mapping[str, bytes]:
        """Return a rig's textures by file name, baked in the background when nobody has.

        Raises:
            Busy: If so many others were asked for since that this one was not baked.
        """
        if not texture_names(rig):
            return {}
        return await self._textures.get(_person_key(rig), lambda: self._baked(rig))

    def bake(self, rig: Rig) -> None:
        """Have a rig's textures baked in the background: somebody is about to see its face."""
        if self.texture_names(rig) and not self._closing.is_set():
            self._textures.begin(_person_key(rig), lambda: self._baked(rig))

    def _baked(self, rig: Rig) -> Mapping[str, bytes]:
        try:
            return textures_of(rig, bake=self._bake, cancelled=self._closing.is_set)
        except Cancelled:
            raise
        except Exception:
            _LOG.exception("textures could not be baked", rig=rig.id)
            raise

    async def export(
        self, rig: Rig, key: str, make: Callable[[Mapping[str, bytes]], bytes], *, textured: bool
    ) -> bytes:
        """Return a file that depends on its `key` alone.

        Args:
            rig: Whose maps it embeds.
            key: Its name.
            make: Writes it with those maps.
            textured: Whether there are to be any.
        """
        maps = await self.textures(rig) if textured else {}
        name = hashlib.sha256(key.encode()).hexdigest()[:32]
        return await self._file(name, lambda: make(maps))

    async def written(self, make: Callable[[], bytes]) -> bytes:
        """Return a file that is made once and not kept."""
        return await asyncio.get_running_loop().run_in_executor(self._files_pool, make)

    def _known(self, name: str) -> str | None:
        """Return the name or the row's id that a name or any id of a rig stands for.

        Ids are named by what has no other name, so that one step leads there.
        """
        if name in _named() or self._store.rig(name):
            return name
        known = self._names.get(name) or self._store.name_of_rig(name)
        return known if known in _named() or (known and self._store.rig(known)) else None

    async def _known_when_built(self, rig_id: str) -> str | None:
        """Return the name of the rig with an id that no one has asked this store for by name."""
        if not _ID.fullmatch(rig_id):
            return None
        for name in _named():  # Once for each name: an id that is not built is not known.
            if name not in self._names.values():
                await self._built_in(name)
            if rig_id in self._names:
                return self._names[rig_id]
        return None

    async def _made_from(self, row_id: str) -> tuple[str, Steps]:
        """Return the named rig that a row's comes from, and what was changed, step by step.

        Raises:
            NotFound: If a rig between is not there any more.
        """
        steps: dict[str, Mapping[str, Any]] = {}
        known: str | None = row_id
        while known is not None and known not in _named():
            row = self._store.rig(known)
            if row is None or row.id in steps:
                raise self._unknown(row_id)
            steps[row.id] = row.changes
            known = self._known(row.base) or await self._known_when_built(row.base)
        if known is None:
            raise self._unknown(row_id)
        return known, list(reversed(steps.values()))

    def _kept(self, root: str, changes: Mapping[str, Any]) -> str | None:
        """Return the row of the rig that `changes` make of `root`, if there is one."""
        wanted = _content(changes)
        rows = (row for row in self._store.rigs() if row.base == root)
        return next((row.id for row in rows if _content(row.changes) == wanted), None)

    @contextmanager
    def _admitted(self, key: str) -> Iterator[None]:
        """Let somebody derive a rig, if there is room for it; what is made already costs nothing.

        Raises:
            Busy: If there is none, or too many are being derived.
        """
        if key in self._rigs:
            yield
            return
        if len(self._deriving) >= _DERIVED_AT_ONCE:
            message = f"{len(self._deriving)} rigs are being derived; ask for this one again"
            raise Busy("too_many_derivations", message, retry_after=2)
        self._make_room()
        self._deriving.append(key)
        try:
            yield
        finally:
            self._deriving.remove(key)

    def _is_full(self) -> bool:
        # Those that are being derived are counted: each has been promised its place.
        return self._store.rig_count() + len(self._deriving) >= self._limit

    def _make_room(self) -> None:
        # A session's row is saved a second after it moved: what is younger may be in use.
        ago = time.time() - _PASSING_SECONDS
        if self._is_full() and not self._store.remove_passing_rigs(ago):
            message = f"at most {self._limit} rigs are kept; RISORIUS_MAX_RIGS allows more"
            raise Busy("too_many_rigs", message, retry_after=60)

    def _note_maker(self, rig_id: str) -> None:
        if self._access.maker and rig_id not in _named():
            self._store.note_maker(rig_id, self._access.maker)

    async def _built_in(self, name: str) -> Rig:
        rig = await self._rigs.get(name, lambda: builtin_rig(name))
        if rig.id not in self._names:
            self._names[rig.id] = name
            self._store.name_rig(rig.id, name)
        return rig

    async def _file(self, key: str, make: Callable[[], bytes]) -> bytes:
        path = self._cache_dir / f"{key}-{ENGINE_HASH[:12]}.glb"
        try:
            return await self._files.get(key, lambda: _stored(path, make, self._cache_bytes))
        except EngineError as error:
            raise refused_by_engine(error) from error

    def _unknown(self, name: str) -> NotFound:
        known = [*_named(), *(row.id for row in self._store.rigs(self._access.key))]
        hint = did_you_mean(name, _named())
        return NotFound("unknown_rig", f"there is no rig {name!r}{hint}", known=known)


def merged_changes(earlier: Mapping[str, Any], later: Mapping[str, Any]) -> dict[str, Any]:
    """Return the changes that come to the same as `earlier`, then `later`.

    Tissue and muscles are changed field by field, action units and emotions as a whole.
    """
    merged = {**earlier, **later}
    for kind in ("recipe", "tissue", "muscles"):
        if kind in earlier and kind in later:
            merged[kind] = _merged_fields(earlier[kind], later[kind])
    for kind in ("action_units", "emotions"):
        if kind in earlier and kind in later:
            merged[kind] = {**earlier[kind], **later[kind]}
    return merged


def _merged_fields(earlier: Mapping[str, Any], later: Mapping[str, Any]) -> dict[str, Any]:
    merged = dict(earlier)
    for name, value in later.items():
        both = isinstance(merged.get(name), Mapping) and isinstance(value, Mapping)
        merged[name] = _merged_fields(merged[name], value) if both else value
    return merged


def _recipe_of(base: Rig, changes: Mapping[str, Any]) -> Recipe | None:
    """Return the person that `changes` make of `base`, if it is one and they can be read."""
    if base.recipe is None:
        return None
    with suppress(EngineError, TypeError, ValueError, AttributeError):
        return Recipe.of(changes.get("recipe") or {}, base.recipe)
    return None


def _in_full(changes: Mapping[str, Any], recipe: Recipe | None) -> Mapping[str, Any]:
    """Return changes with the whole of a recipe that they change.

    What is left out of it may change with the engine, a person may not.
    """
    if recipe is None or "recipe" not in changes:
        return changes
    return {**changes, "recipe": recipe.to_json()}


def _content(changes: Mapping[str, Any]) -> str:
    """Return changes in one form, but for the name, which changes no face."""
    return json.dumps({**changes, "name": None}, sort_keys=True)


def _key(base: str, changes: Mapping[str, Any]) -> str:
    return f"{base}+{hashlib.sha256(repr(sorted(changes.items())).encode()).hexdigest()}"


def _stored(path: Path, make: Callable[[], bytes], most_bytes: int) -> bytes:
    """Return the file at `path`, or make and keep it; an unwritable folder costs only time."""
    with suppress(OSError):
        return read_kept(path, lambda file: file.read())
    data = make()
    try:
        keep(path, lambda file: file.write(data), most_bytes)
    except OSError:
        _LOG.warning("the cache folder cannot be written", path=str(path.parent))
    return data
