"""The web server: one process, one worker, a socket with a small send buffer."""

from __future__ import annotations

import logging
import re
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import uvicorn
from fastapi import FastAPI

from .lines import Line
from .settings import Settings

# A viewer that stops reading may hold this much of stale frames; the system's default is 4 MB.
_SEND_BUFFER_BYTES = 65_536
_SHUTDOWN_SECONDS = 3
_IDLE_SECONDS = 75
"""After which a connection that nobody uses is closed: later than clients and proxies let go of
theirs, mostly a minute, or now and then one would send a request into a line that is being cut."""
_START_SECONDS = 60.0
_TICKET = re.compile(r"(?<=[?&]ticket=)[^&\s]+")


def listen(host: str, port: int) -> socket.socket:
    """Return a listening socket.

    Raises:
        OSError: If the address cannot be used.
    """
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # With the protocol named: asyncio sends at once only on sockets that say they are TCP's, and
    # the body of each answer would wait 40 ms for its head to be acknowledged.
    listener = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    try:
        listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        # Accepted connections inherit it.
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SEND_BUFFER_BYTES)
        listener.bind((host, port))
        listener.listen(128)
        listener.set_inheritable(True)
    except BaseException:
        listener.close()
        raise
    return listener


def server_of(app: FastAPI, settings: Settings) -> uvicorn.Server:
    """Return a server for `app`."""
    config = uvicorn.Config(
        app,
        ws=Line,
        # Deflating a frame costs more than sending it.
        ws_per_message_deflate=False,
        ws_max_size=4 * settings.max_message_bytes,
        workers=1,
        access_log=False,
        log_level="warning",
        server_header=False,
        timeout_keep_alive=_IDLE_SECONDS,
        timeout_graceful_shutdown=_SHUTDOWN_SECONDS,
    )
    for name in ("uvicorn.error", "uvicorn.access"):
        logging.getLogger(name).addFilter(_without_tickets)
    logging.getLogger("uvicorn.error").addFilter(_is_news)
    return uvicorn.Server(config)


def _is_news(record: logging.LogRecord) -> bool:
    """Drop what uvicorn says of every socket that is refused with a status, as it should be."""
    return "without completing handshake" not in record.getMessage()


def _without_tickets(record: logging.LogRecord) -> bool:
    """Keep tickets, which stand in addresses, out of the log, whatever its level."""
    message = record.getMessage()
    if _TICKET.search(message):
        record.msg, record.args = _TICKET.sub("…", message), ()
    return True


def url_of(listener: socket.socket) -> str:
    """Return the URL at which a listening socket is reached from this machine."""
    host, port = listener.getsockname()[:2]
    if host in ("0.0.0.0", "::"):
        host = "127.0.0.1"
    return f"http://[{host}]:{port}" if ":" in host else f"http://{host}:{port}"


@contextmanager
def running(app: FastAPI, settings: Settings) -> Iterator[str]:
    """Serve `app` from a thread on a free port, and yield the URL.

    Raises:
        RuntimeError: If it does not start within a minute.
    """
    listener = listen("127.0.0.1", 0)
    server = server_of(app, settings)
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]}, daemon=True)
    thread.start()
    deadline = time.monotonic() + _START_SECONDS
    try:
        while not server.started:
            if not thread.is_alive() or time.monotonic() > deadline:
                raise RuntimeError("the service did not start")
            time.sleep(0.02)
        yield url_of(listener)
    finally:
        server.should_exit = True
        thread.join(timeout=2 * _SHUTDOWN_SECONDS + 10)
        listener.close()
