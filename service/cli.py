"""The command line: from `serve` to `warm`.

Every command ends with 0, or with 2 and one clear sentence; `soak` with 1 where a figure is bad.
"""

from __future__ import annotations

import asyncio
import errno
import gc
import os
import sys
from typing import TYPE_CHECKING, Annotated, Any

import structlog
import typer

from . import (
    bench_commands,
    dataset_commands,
    face_commands,
    key_commands,
    picture_commands,
    render_commands,
)
from .terminal import console as _console
from .terminal import refuse as _refuse
from .version import version

if TYPE_CHECKING:
    from .kernels import Compiling

app = typer.Typer(
    help="A physically simulated face, driven by FACS.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
app.add_typer(key_commands.app, name="keys")


def main() -> None:
    """Run the command line."""
    _log_to_stderr()
    app()


def _log_to_stderr() -> None:
    """Keep the log apart from answers, with short tracebacks: the arrays of a rig fill books."""
    structlog.configure(
        processors=[
            structlog.processors.add_log_level,
            structlog.processors.TimeStamper(fmt="%Y-%m-%d %H:%M:%S"),
            structlog.dev.ConsoleRenderer(
                colors=False, exception_formatter=structlog.dev.plain_traceback
            ),
        ],
        logger_factory=structlog.PrintLoggerFactory(sys.stderr),
    )


def _show_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"risorius {version()}")
        raise typer.Exit


@app.callback()
def _options(
    _version: Annotated[
        bool,
        typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version."),
    ] = False,
) -> None:
    """A physically simulated face, driven by FACS."""


@app.command()
def serve(
    host: Annotated[str | None, typer.Option(help="Address to listen on.")] = None,
    port: Annotated[int | None, typer.Option(help="Port to listen on; 0 takes a free one.")] = None,
    workers: Annotated[int, typer.Option(help="Only 1: sessions live in the process.")] = 1,
) -> None:
    """Serve the viewer, the API and the stream."""
    # Nothing that imports make is garbage: looking for it takes a tenth of their time.
    gc.disable()
    from .kernels import begin_compiling, end

    compiling = begin_compiling()  # First: on a new machine it takes longest.
    try:
        _serve(host, port, workers, compiling)
    finally:
        end(compiling)
        gc.enable()


def _serve(host: str | None, port: int | None, workers: int, compiling: Compiling | None) -> None:
    try:
        from pydantic import ValidationError

        from .explaining import explain
        from .keys import first_key, is_loopback
        from .serving import serve_until_stopped
        from .settings import Settings
        from .store import Store, StoreUnavailable
    finally:
        gc.enable()

    if max(workers, _asked_workers()) > 1:
        _refuse(
            "risorius runs as one process, because sessions live in it; start it with one worker."
        )
    asked: dict[str, Any] = {"host": host, "port": port}
    try:
        settings = Settings(**{name: value for name, value in asked.items() if value is not None})
    except ValidationError as error:
        _refuse(f"A setting is not valid: {explain(list(error.errors()))}.")
    try:
        # Opened once beforehand: a server that fails while it starts answers with a traceback.
        store = Store(settings.database)
    except StoreUnavailable as unavailable:
        _refuse(str(unavailable))
    key = first_key(store, settings)
    has_key = bool(settings.api_keys or store.keys())
    store.close()
    if key is not None:
        _console.print(f"The key of this service, shown this once: {key}", soft_wrap=True)
    if not has_key and not is_loopback(settings.host):
        _refuse(
            f"Without a key risorius listens on this machine only, and {settings.host} is reached "
            "from others: make one with `risorius keys add NAME`, or set RISORIUS_API_KEYS."
        )
    try:
        asyncio.run(serve_until_stopped(settings, _console, compiling))
    except KeyboardInterrupt:
        _console.print("stopped")
    except OSError as error:
        if error.errno not in (errno.EADDRINUSE, errno.EADDRNOTAVAIL, errno.EACCES, -2, -5):
            raise
        reason = "is in use" if error.errno == errno.EADDRINUSE else "cannot be used"
        _refuse(
            f"Port {settings.port} on {settings.host} {reason}; choose another one with --port."
        )


app.command()(render_commands.clip)
app.command()(dataset_commands.dataset)
app.command()(picture_commands.sheet)
app.command()(picture_commands.screens)
app.command()(bench_commands.levels)
app.command()(bench_commands.bench)
app.command()(bench_commands.soak)
app.command()(face_commands.measure)
app.command()(face_commands.analyze)
app.command()(face_commands.inverse)
app.command()(face_commands.emotions)
app.command()(face_commands.units)
app.command()(face_commands.separability)
app.command()(bench_commands.startup)


@app.command()
def warm() -> None:
    """Compile the kernels and build the rigs into the cache, so that the next start is quick."""
    from engine import (
        BUILTIN_RIGS,
        Keyframe,
        Simulator,
        builtin_rig,
        surface_to_glb,
        textures_of,
        warm_kernels,
    )

    with _console.status("compiling the kernels of live faces"):
        warm_kernels()
    for name in BUILTIN_RIGS:
        with _console.status(f"warming the {name} rig"):
            rig = builtin_rig(name)
            simulator = Simulator(rig)
            simulator.add("face")
            simulator.apply("face", Keyframe(action_units={"AU12": 1.0}))
            simulator.step()
            surface_to_glb(rig)
            textures_of(rig)
    _console.print("The kernels are compiled and the rigs are built.")


def _asked_workers() -> int:
    """Return the number of workers that the environment asks servers for."""
    asked = os.environ.get("WEB_CONCURRENCY", "1")
    return int(asked) if asked.isdecimal() else 1
