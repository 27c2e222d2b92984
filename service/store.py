"""The store: every table and every SQL statement of the service."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, ClassVar, TypeVar

from sqlalchemy import (
    JSON,
    BigInteger,
    Connection,
    Engine,
    Float,
    ForeignKey,
    String,
    Text,
    bindparam,
    create_engine,
    delete,
    event,
    func,
    insert,
    inspect,
    make_url,
    select,
    text,
    update,
)
from sqlalchemy.exc import ArgumentError, IntegrityError, SQLAlchemyError
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column, sessionmaker
from sqlalchemy.pool import StaticPool
from sqlalchemy.schema import CreateColumn

Row = TypeVar("Row", bound="Table")
Answer = TypeVar("Answer")

FINISHED = ("done", "failed", "cancelled")
"""States of a clip that has ended."""
_BUSY_TIMEOUT_MS = 5000


class Table(DeclarativeBase):
    """Base of the tables."""

    type_annotation_map: ClassVar[dict[Any, Any]] = {dict[str, Any]: JSON, list[Any]: JSON}


class KeyRow(Table):
    """A key: whose it is, the hash of it, and what it may take where that is not the usual."""

    __tablename__ = "api_keys"

    name: Mapped[str] = mapped_column(String(64), primary_key=True)
    id: Mapped[str] = mapped_column(String(16), unique=True)
    digest: Mapped[str] = mapped_column(String(64))
    sessions: Mapped[int | None]
    viewers: Mapped[int | None]
    clip_seconds: Mapped[float | None] = mapped_column(Float)
    upload_bytes: Mapped[int | None] = mapped_column(BigInteger)
    created: Mapped[float] = mapped_column(Float)


class RigRow(Table):
    """A derived rig: the name of the rig it came from and what was changed."""

    __tablename__ = "rigs"

    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    base: Mapped[str] = mapped_column(String(64))
    changes: Mapped[dict[str, Any]]
    created: Mapped[float] = mapped_column(Float)


class RigMakerRow(Table):
    """A key that made a derived rig: several may make the same one."""

    __tablename__ = "rig_makers"

    rig: Mapped[str] = mapped_column(String(64), primary_key=True)
    made_by: Mapped[str] = mapped_column(String(64), primary_key=True)


class PassingRigRow(Table):
    """A derived rig that is a step of a live edit: nobody asked to keep it."""

    __tablename__ = "passing_rigs"

    id: Mapped[str] = mapped_column(String(64), primary_key=True)


class NamedRigRow(Table):
    """An id that a rig had: another engine may give the rig of that name another one."""

    __tablename__ = "named_rigs"

    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    name: Mapped[str] = mapped_column(String(64))


class SessionRow(Table):
    """A session: its rig, its model, the controls it held last, and its idle life if it has one.

    `tick` is how long it has lived, services before this one included; `begins` the tick at which
    its tail begins, with what was held `before`, where that is not the beginning.
    """

    __tablename__ = "sessions"

    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    rig: Mapped[str] = mapped_column(String(64))
    model: Mapped[dict[str, Any]]
    held: Mapped[list[Any]]
    created: Mapped[float] = mapped_column(Float)
    used: Mapped[float] = mapped_column(Float)
    made_by: Mapped[str] = mapped_column(String(64), default="", server_default="")
    life: Mapped[dict[str, Any] | None] = mapped_column(JSON(none_as_null=True), default=None)
    tick: Mapped[int] = mapped_column(BigInteger, default=0, server_default="0")
    begins: Mapped[int | None] = mapped_column(BigInteger, default=None)
    before: Mapped[list[Any] | None] = mapped_column(JSON(none_as_null=True), default=None)


class TailRow(Table):
    """A piece of a session's timeline: what one commit brought, up to the tick `last`."""

    __tablename__ = "session_tails"

    session: Mapped[str] = mapped_column(
        String(64), ForeignKey("sessions.id", ondelete="CASCADE"), primary_key=True
    )
    number: Mapped[int] = mapped_column(BigInteger, primary_key=True)
    last: Mapped[int] = mapped_column(BigInteger)
    commands: Mapped[list[Any]]


class ClipRow(Table):
    """A clip: what was asked for, how far it is, and what it gave."""

    __tablename__ = "clips"

    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    rig: Mapped[str] = mapped_column(String(64))
    fps: Mapped[int]
    request: Mapped[dict[str, Any]]
    status: Mapped[str] = mapped_column(String(16), index=True)
    message: Mapped[str] = mapped_column(Text, default="")
    report: Mapped[dict[str, Any]]
    created: Mapped[float] = mapped_column(Float)
    finished: Mapped[float | None] = mapped_column(Float, default=None)
    made_by: Mapped[str] = mapped_column(String(64), default="", server_default="")


_KEEP_SESSION = update(SessionRow).where(SessionRow.id == bindparam("which"))
"""One statement for all rows of a commit, compiled once; it sets what their values name."""
_KEEP_PIECE = insert(TailRow).from_select(
    ["session", "number", "last", "commands"],
    # Of a session that was closed meanwhile there is no row, and nothing is kept.
    select(
        SessionRow.id,
        bindparam("piece", type_=BigInteger),
        bindparam("end", type_=BigInteger),
        bindparam("lines", type_=JSON),
    ).where(SessionRow.id == bindparam("which")),
)
_CUT_TAIL = delete(TailRow).where(
    TailRow.session == bindparam("which"), TailRow.last <= bindparam("first")
)


class StoreUnavailable(Exception):
    """A database that cannot be opened; the message is one sentence."""


class Store:
    """Connections to one database; every method is one short transaction."""

    def __init__(self, url: str) -> None:
        """Open the database at `url` and make the tables that it lacks.

        Raises:
            StoreUnavailable: If it cannot be opened, or its driver is not installed.
        """
        try:
            self.engine = _connect(url)
            Table.metadata.create_all(self.engine)
            _add_columns(self.engine)
        except (OSError, ImportError, SQLAlchemyError) as error:
            reason = getattr(error, "orig", None) or error
            raise StoreUnavailable(
                f"The database {_without_password(url)} cannot be opened ({reason}); set "
                "RISORIUS_DATA_DIR to a folder that can be written, or RISORIUS_DATABASE_URL."
            ) from error
        self._session = sessionmaker(self.engine, expire_on_commit=False)
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="store")

    async def aside(self, call: Callable[[], Answer]) -> Answer:
        """Return what `call` returns, called in order on the store's own thread.

        A commit takes parts of a millisecond, and now and then waits for the disk: nothing that
        the event loop should wait for.
        """
        if isinstance(self.engine.pool, StaticPool):
            return call()  # One connection for all: two transactions on it would be one.
        return await asyncio.get_running_loop().run_in_executor(self._thread, call)

    def close(self) -> None:
        """Finish what was asked for and close every connection."""
        self._thread.shutdown(wait=True)
        self.engine.dispose()

    # Keys.

    def add_key(
        self, name: str, *, key_id: str, digest: str, quota: Mapping[str, float | None]
    ) -> bool:
        """Keep a key, and return whether there was none of that name."""
        row = KeyRow(name=name, id=key_id, digest=digest, created=time.time(), **quota)
        try:
            with self._session.begin() as session:
                session.add(row)
        except IntegrityError:
            return False
        return True

    def remove_key(self, name: str) -> bool:
        """Forget a key, and return whether there was one."""
        with self._session.begin() as session:
            gone = session.scalars(delete(KeyRow).where(KeyRow.name == name).returning(KeyRow.id))
            return bool(gone.all())

    def keys(self) -> Sequence[KeyRow]:
        """Return the keys, oldest first."""
        with self._session() as session:
            return session.scalars(select(KeyRow).order_by(KeyRow.created, KeyRow.name)).all()

    # Rigs.

    def add_rig(
        self, rig: str, *, base: str, changes: Mapping[str, Any], passing: bool = False
    ) -> None:
        """Keep a derived rig; one that is there already stays."""
        with self._session.begin() as session:
            if session.get(RigRow, rig) is None:
                session.add(RigRow(id=rig, base=base, changes=dict(changes), created=time.time()))
                if passing:
                    session.merge(PassingRigRow(id=rig))

    def note_maker(self, rig: str, made_by: str) -> None:
        """Remember that a key made a derived rig."""
        with self._session.begin() as session:
            session.merge(RigMakerRow(rig=rig, made_by=made_by))

    def keep_rig(self, rig: str) -> None:
        """Keep a rig for good, if it was a step of a live edit."""
        with self._session.begin() as session:
            session.execute(delete(PassingRigRow).where(PassingRigRow.id == rig))

    def remove_passing_rigs(self, made_before: float) -> int:
        """Forget the older steps of live edits that no session and no clip is on.

        Args:
            made_before: Later ones stay [s since 1970].

        Returns:
            How many there were.
        """
        used = select(SessionRow.rig).union(select(ClipRow.rig))
        passing = select(PassingRigRow.id)
        with self._session.begin() as session:
            removed = session.scalars(
                delete(RigRow)
                .where(RigRow.id.in_(passing), RigRow.id.not_in(used))
                .where(RigRow.created < made_before)
                .returning(RigRow.id)
            ).all()
            session.execute(delete(PassingRigRow).where(PassingRigRow.id.in_(removed)))
            session.execute(delete(RigMakerRow).where(RigMakerRow.rig.in_(removed)))
        return len(removed)

    def name_rig(self, rig: str, name: str) -> None:
        """Remember that the rig of `name`, built in or derived, has the id `rig`."""
        with self._session.begin() as session:
            session.merge(NamedRigRow(id=rig, name=name))

    def name_of_rig(self, rig: str) -> str | None:
        """Return the name of the rig that had this id, if there was one."""
        row = self._get(NamedRigRow, rig)
        return row.name if row else None

    def rig_count(self) -> int:
        """Return how many derived rigs are kept."""
        with self._session() as session:
            return session.scalar(select(func.count()).select_from(RigRow)) or 0

    def rig(self, rig: str) -> RigRow | None:
        """Return the derived rig of that id."""
        return self._get(RigRow, rig)

    def rigs(self, made_by: str | None = None) -> Sequence[RigRow]:
        """Return the derived rigs, or those that a key made, oldest first."""
        rows = select(RigRow).order_by(RigRow.created)
        if made_by is not None:
            made = select(RigMakerRow.rig).where(RigMakerRow.made_by == made_by)
            rows = rows.where(RigRow.id.in_(made))
        with self._session() as session:
            return session.scalars(rows).all()

    # Sessions.

    def add_session(
        self,
        session_id: str,
        *,
        rig: str,
        model: Mapping[str, str],
        made_by: str = "",
        life: Mapping[str, Any] | None = None,
    ) -> SessionRow:
        """Keep a new session of a key, and the idle life that it has."""
        now = time.time()
        row = SessionRow(
            id=session_id,
            rig=rig,
            model=dict(model),
            held=[],
            created=now,
            used=now,
            made_by=made_by,
            life=None if life is None else dict(life),
        )
        with self._session.begin() as session:
            session.add(row)
        return row

    def keep_sessions(self, rows: Sequence[Mapping[str, Any]]) -> None:
        """Keep what sessions hold now, in one transaction; those that were closed stay so.

        Args:
            rows: Of each its `id`, `rig`, `held`, `used`, `life` and, if it has lived on, `tick`,
                and what of its `tail` is not kept yet.
        """
        if not rows:
            return
        names = ("rig", "held", "used", "life")
        told = [{"which": row["id"], **{name: row[name] for name in names}} for row in rows]
        ticks = [{"which": row["id"], "tick": row["tick"]} for row in rows if "tick" in row]
        tails = [(row["id"], row["tail"]) for row in rows if row.get("tail") is not None]
        with self.engine.begin() as connection:
            connection.execute(_KEEP_SESSION, told)
            if ticks:
                connection.execute(_KEEP_SESSION, ticks)
            if tails:
                _keep_tails(connection, tails)

    def keep_ticks(self, ticks: Mapping[str, int]) -> None:
        """Keep how long sessions have lived, by their ids."""
        with self.engine.begin() as connection:
            connection.execute(
                _KEEP_SESSION, [{"which": each, "tick": tick} for each, tick in ticks.items()]
            )

    def tail(self, session_id: str) -> list[tuple[int, list[Any]]]:
        """Return number and commands of each piece of a session's timeline, in order."""
        rows = select(TailRow).where(TailRow.session == session_id).order_by(TailRow.number)
        with self._session() as session:
            return [(row.number, row.commands) for row in session.scalars(rows)]

    def remove_session(self, session_id: str) -> None:
        """Forget a session."""
        with self._session.begin() as session:
            session.execute(delete(SessionRow).where(SessionRow.id == session_id))

    def remove_idle_sessions(self, used_before: float, *, but: Sequence[str]) -> None:
        """Forget the sessions that nobody used since, except those of `but`."""
        with self._session.begin() as session:
            idle = SessionRow.used < used_before
            session.execute(delete(SessionRow).where(idle, SessionRow.id.not_in(but)))

    def session(self, session_id: str) -> SessionRow | None:
        """Return the session of that id."""
        return self._get(SessionRow, session_id)

    def session_count(self) -> int:
        """Return how many sessions are kept."""
        with self._session() as session:
            return session.scalar(select(func.count()).select_from(SessionRow)) or 0

    def sessions(self, made_by: str | None = None) -> Sequence[SessionRow]:
        """Return the sessions, or those of a key, oldest first."""
        rows = select(SessionRow).order_by(SessionRow.created)
        if made_by is not None:
            rows = rows.where(SessionRow.made_by == made_by)
        with self._session() as session:
            return session.scalars(rows).all()

    # Clips.

    def add_clip(
        self,
        clip: str,
        *,
        rig: str,
        fps: int,
        request: Mapping[str, Any],
        report: Mapping[str, Any] | None = None,
        made_by: str = "",
    ) -> ClipRow:
        """Keep a clip of a key that waits to be rendered, and what is known of it already."""
        row = ClipRow(
            id=clip,
            rig=rig,
            fps=fps,
            request=dict(request),
            status="queued",
            message="",
            report=dict(report or {}),
            created=time.time(),
            made_by=made_by,
        )
        with self._session.begin() as session:
            session.add(row)
        return row

    def keep_clip(
        self,
        clip: str,
        *,
        status: str,
        message: str = "",
        report: Mapping[str, Any] | None = None,
    ) -> None:
        """Keep how far a clip is."""
        values: dict[str, Any] = {"status": status, "message": message}
        if report is not None:
            values["report"] = dict(report)
        if status in FINISHED:
            values["finished"] = time.time()
        with self._session.begin() as session:
            session.execute(update(ClipRow).where(ClipRow.id == clip).values(**values))

    def remove_clip(self, clip: str) -> None:
        """Forget a clip."""
        with self._session.begin() as session:
            session.execute(delete(ClipRow).where(ClipRow.id == clip))

    def ended_clips(self, before: float) -> Sequence[str]:
        """Return the ids of the clips that ended before a time [s since 1970]."""
        with self._session() as session:
            return session.scalars(select(ClipRow.id).where(ClipRow.finished < before)).all()

    def clip(self, clip: str) -> ClipRow | None:
        """Return the clip of that id."""
        return self._get(ClipRow, clip)

    def clips(self, made_by: str | None = None, since: float = 0.0) -> Sequence[ClipRow]:
        """Return the clips, or those of a key, made since a time [s since 1970], oldest first."""
        rows = select(ClipRow).where(ClipRow.created >= since)
        rows = rows.order_by(ClipRow.created, ClipRow.id)
        if made_by is not None:
            rows = rows.where(ClipRow.made_by == made_by)
        with self._session() as session:
            return session.scalars(rows).all()

    def clip_count(self) -> int:
        """Return how many clips are kept."""
        with self._session() as session:
            return session.scalar(select(func.count()).select_from(ClipRow)) or 0

    def _get(self, table: type[Row], key: str) -> Row | None:
        with self._session() as session:
            return session.get(table, key)


def _keep_tails(connection: Connection, tails: Sequence[tuple[str, Any]]) -> None:
    """Add a piece to the timelines of sessions, and forget what came before they begin now."""
    pieces = [
        {"which": which, "piece": tail.number, "end": tail.last, "lines": tail.write()}
        for which, tail in tails
    ]
    connection.execute(_KEEP_PIECE, pieces)
    for which, tail in tails:
        if tail.begins is not None:
            begins = {"which": which, "begins": tail.begins, "before": tail.before}
            connection.execute(_KEEP_SESSION, begins)
            connection.execute(_CUT_TAIL, {"which": which, "first": tail.begins})


def _add_columns(engine: Engine) -> None:
    """Give the tables of an earlier version the columns that they lack; each has a default."""
    present = inspect(engine)
    with engine.begin() as connection:
        for table in Table.metadata.sorted_tables:
            names = {column["name"] for column in present.get_columns(table.name)}
            for column in table.columns:
                if column.name not in names:
                    written = CreateColumn(column).compile(dialect=engine.dialect)
                    connection.execute(text(f"ALTER TABLE {table.name} ADD COLUMN {written}"))


def _without_password(url: str) -> str:
    try:
        return make_url(url).render_as_string(hide_password=True)
    except ArgumentError:
        return "of RISORIUS_DATABASE_URL"


def _connect(url: str) -> Engine:
    """Open a database; SQLite files are made with their folder and set up for many readers."""
    parsed = make_url(url)
    if parsed.get_backend_name() != "sqlite":
        return create_engine(url, pool_pre_ping=True)
    if not parsed.database or parsed.database == ":memory:":
        engine = create_engine(url, poolclass=StaticPool, connect_args={"check_same_thread": False})
    else:
        Path(parsed.database).parent.mkdir(parents=True, exist_ok=True)
        engine = create_engine(url, connect_args={"check_same_thread": False})
    event.listen(engine, "connect", _set_up_sqlite)
    return engine


def _set_up_sqlite(connection: Any, _record: object) -> None:
    cursor = connection.cursor()
    cursor.execute("PRAGMA journal_mode=WAL")
    cursor.execute(f"PRAGMA busy_timeout={_BUSY_TIMEOUT_MS}")
    cursor.execute("PRAGMA foreign_keys=ON")
    cursor.execute("PRAGMA synchronous=NORMAL")
    cursor.close()
