"""Expressions without a session: a face that has settled, as a file and as a picture, kept on disk.

They are made in processes of their own, one of a kind at a time, for as long as somebody waits.
"""

from __future__ import annotations

import asyncio
import hashlib
from collections.abc import Awaitable, Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import structlog

from engine import (
    ENGINE_HASH,
    EngineError,
    FacsWarning,
    Keyframe,
    Rig,
    keep,
    parse_facs,
    print_facs,
    read_kept,
)

from .awaited import Awaited
from .bodies import Scale, Units
from .bystanders import Bystanders
from .clashes import clashes
from .errors import Busy, NoPictures, Unprocessable, refused_by_engine
from .expression_orders import Face, FaceOrder, PictureOrder
from .rigs import Rigs, export_tag
from .stage import NOT_BUILT, Look
from .workshop import WorkEnded, Workshop

_LOG = structlog.get_logger("expressions")
_FADE = 0.15
"""Seconds over which an expression is taken up before it settles; a jump excites the tissue."""
_RETRY_SECONDS = 5
_MOST_CHARACTERS = 2048
"""Of a FACS string, as in the bodies of other calls."""


@dataclass(frozen=True)
class Expression:
    """What a FACS string asks of a rig.

    Attributes:
        keyframe: What is played.
        facs: The string in its one form.
        warnings: What of it breaks a rule of FACS.
    """

    keyframe: Keyframe
    facs: str
    warnings: tuple[FacsWarning, ...]


def read_expression(facs: str, scale: Scale, rig: Rig) -> Expression:
    """Return what `facs` asks of `rig`.

    Raises:
        Unprocessable: If it cannot be read, or names what the rig does not have.
    """
    if len(facs) > _MOST_CHARACTERS:
        message = f"the FACS string has {len(facs)} characters; at most {_MOST_CHARACTERS}"
        raise Unprocessable("invalid_notation", message)
    try:
        terms = parse_facs(facs, scale)
        units = {term.key: term.intensity for term in terms}
        keyframe = Keyframe(action_units=units, fade=_FADE)
        rig.check(keyframe)
    except EngineError as error:
        raise refused_by_engine(error) from error
    found = clashes(Units(facs=facs, scale=scale), keyframe, rig)
    return Expression(keyframe, print_facs(terms), tuple(found))


class Expressions:
    """Files and pictures of expressions, by what they show; who has one's tag needs no other."""

    def __init__(
        self,
        rigs: Rigs,
        *,
        cache_dir: Path,
        cache_bytes: int,
        viewer_dir: Path,
        queue_limit: int,
        bystanders: Bystanders | None = None,
    ) -> None:
        self._rigs = rigs
        self._folder = cache_dir / "files"
        self._cache_bytes = cache_bytes
        self._viewer_dir = viewer_dir
        self._faces = Workshop("expression_process", bystanders=bystanders)
        self._pictures = Workshop("picture_process", str(cache_dir), str(viewer_dir))
        self._under_way: Awaited[bytes] = Awaited(most=queue_limit)

    def face_tag(self, rig: Rig, expression: Expression, level: str, *, textured: bool) -> str:
        """Return what names the file of an expression.

        Raises:
            Unprocessable: If there is no such level of detail.
        """
        drawn = export_tag(rig, level, textured=textured)
        return _tag(drawn, expression.facs, ENGINE_HASH)

    def picture_tag(self, rig: Rig, expression: Expression, look: Look) -> str:
        """Return what names a picture of an expression."""
        return _tag(rig.id, expression.facs, repr(look), ENGINE_HASH, _viewer(self._viewer_dir))

    async def face(
        self, name: str, rig: Rig, expression: Expression, level: str, *, textured: bool
    ) -> bytes:
        """Return the GLB file of an expression, settled and baked.

        Args:
            name: Of the rig, or its id.
            rig: Whose expression it is.
            expression: Which.
            level: Of detail.
            textured: Whether the maps of skin and eyes are embedded.

        Raises:
            Busy: If too many others are being made.
        """

        async def make() -> bytes:
            maps = await self._rigs.textures(rig) if textured else {}
            order = FaceOrder(await self._face(name, expression), level, maps)
            data: bytes = await self._faces.make(order)
            return data

        tag = self.face_tag(rig, expression, level, textured=textured)
        return await self._kept(f"{tag}.glb", make)

    async def picture(self, name: str, rig: Rig, expression: Expression, look: Look) -> bytes:
        """Return a PNG picture of an expression, as the viewer draws it.

        Args:
            name: Of the rig, or its id.
            rig: Whose expression it is.
            expression: Which.
            look: How it is looked at.

        Raises:
            Busy: If too many others are being made.
            NoPictures: If there is no viewer or no Chromium to draw it with.
        """

        async def make() -> bytes:
            if not (self._viewer_dir / "index.html").is_file():
                raise NoPictures("no_pictures", NOT_BUILT)
            await self._rigs.textures(rig)  # Baked here, so that pictures of others go on.
            order = PictureOrder(await self._face(name, expression), look)
            data: bytes = await self._pictures.make(order)
            return data

        return await self._kept(f"{self.picture_tag(rig, expression, look)}.png", make)

    async def stop(self) -> None:
        """Stop making, and end the processes."""
        await self._under_way.stop()
        await self._faces.stop()
        await self._pictures.stop()

    async def _face(self, name: str, expression: Expression) -> Face:
        root, steps = await self._rigs.made_from(name)
        return Face(root, steps, expression.keyframe)

    async def _kept(self, file: str, make: Callable[[], Awaitable[bytes]]) -> bytes:
        """Return a file from the cache folder, or make and keep it."""
        path = self._folder / file
        with suppress(OSError):
            return await asyncio.to_thread(read_kept, path, lambda kept: kept.read())

        async def made() -> bytes:
            data = await make()
            await asyncio.to_thread(_keep, path, data, self._cache_bytes)
            return data

        try:
            return await self._under_way.get(file, made)
        except WorkEnded as error:
            _LOG.exception("an expression could not be made", file=file)
            message = "what made it ended early; ask for it again, and look into the log if it does"
            raise Busy("not_made", message, retry_after=_RETRY_SECONDS) from error


def _keep(path: Path, data: bytes, most_bytes: int) -> None:
    try:
        keep(path, lambda file: file.write(data), most_bytes)
    except OSError:
        _LOG.warning("the cache folder cannot be written", path=str(path.parent))


def _tag(*parts: str) -> str:
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:32]


@lru_cache(maxsize=4)
def _viewer(folder: Path) -> str:
    """Return what names a built viewer: its page names every part of it by content."""
    with suppress(OSError):
        return hashlib.sha256((folder / "index.html").read_bytes()).hexdigest()
    return ""
