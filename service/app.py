"""The application: every part wired together, errors in one shape, the viewer mounted."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from http import HTTPStatus

import structlog
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.middleware.cors import CORSMiddleware
from starlette.exceptions import HTTPException
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Match, Mount, Route, compile_path
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from . import stream
from .agents.endpoint import PATHS as MCP_PATHS
from .agents.endpoint import McpEndpoint
from .api import router
from .components import Components
from .errors import Refused, error_body, json_response
from .explaining import did_you_mean, explain
from .guard import Guard, RateLimit
from .heads import Heads
from .idempotency import Idempotency
from .kernels import Compiling
from .keys import KeyRing
from .metrics import CountRequests, Metrics
from .settings import Settings
from .tickets import Tickets
from .uploads import Uploads
from .version import version

_LOG = structlog.get_logger("service")
_NOT_BUILT = (
    "The viewer is not built: run `npm ci && npm run build` in static/ (node 20.19 or newer), "
    "or `make run`, then restart; the API is at /docs.\n"
)
# What the viewer's files never answer, so that a wrong method there is still said to be one.
_API_PATHS = ("/api", "/metrics", "/docs", "/openapi.json", "/mcp")


def create_app(settings: Settings | None = None, *, compiling: Compiling | None = None) -> FastAPI:
    """Return an application of its own: nothing is shared with another one.

    Args:
        settings: None takes those of the environment.
        compiling: Kernels that are being compiled already; it waits for them, and ends with them.
    """
    settings = settings or Settings()
    metrics = Metrics()
    rate = RateLimit(settings.requests_per_second)
    keys, tickets = KeyRing(settings), Tickets()
    mcp = McpEndpoint()

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        parts = Components.make(settings, metrics, rate, keys, tickets)
        metrics.watch_simulation(parts.runner.counters, parts.runner.load)
        metrics.watch_times(
            "loop_delay_seconds", "How late the event loop woke.", parts.loop_delay.times
        )
        metrics.gauge("viewers", "Sockets open.", lambda: parts.sessions.viewer_count)
        app.state.parts = parts
        parts.compiling = compiling
        parts.start()
        try:
            yield
        finally:
            await mcp.stop()
            await parts.stop()

    app = FastAPI(
        title="Risorius",
        version=version(),
        summary="A physically simulated face, driven by FACS.",
        lifespan=lifespan,
        redoc_url=None,
    )
    app.include_router(router)
    app.include_router(stream.router)
    app.router.routes += [Route(path, mcp) for path in MCP_PATHS]
    _mount_viewer(app, settings)
    _answer_errors(app)
    # The last one added is the outermost.
    app.add_middleware(Heads)
    app.add_middleware(Idempotency)
    if settings.allowed_origins:
        app.add_middleware(
            CORSMiddleware,
            allow_origins=list(settings.allowed_origins),
            allow_methods=["*"],
            allow_headers=["*"],
            expose_headers=["ETag", "Location", "Repr-Digest", "Retry-After"],
        )
    uploads = Uploads(
        settings.clips_folder, limit=settings.max_upload_bytes, most=settings.max_queued_clips
    )
    app.add_middleware(
        Guard, settings=settings, rate=rate, keys=keys, tickets=tickets, uploads=uploads
    )
    app.add_middleware(CountRequests, metrics=metrics)
    return app


class _ViewerMount(Mount):
    """The viewer's files, at every path that is not the API's."""

    def matches(self, scope: Scope) -> tuple[Match, Scope]:
        """Match what the viewer may answer."""
        if str(scope.get("path", "")).startswith(_API_PATHS):
            return Match.NONE, {}
        return super().matches(scope)


class _ViewerFiles(StaticFiles):
    """The built viewer: named by content, so that only its page is asked for again."""

    def __init__(self, settings: Settings) -> None:
        super().__init__(directory=settings.viewer_dir, html=True)
        # Whose pages may drive a face may show it, too; nobody else's can lay it under a click.
        self._holders = " ".join(("'self'", *settings.allowed_origins))

    async def get_response(self, path: str, scope: Scope) -> Response:
        """Return a file, with the headers that a page on a local address needs."""
        response = await super().get_response(path, scope)
        response.headers["X-Content-Type-Options"] = "nosniff"
        response.headers["Content-Security-Policy"] = f"frame-ancestors {self._holders}"
        # The address of the page may hold a ticket.
        response.headers["Referrer-Policy"] = "same-origin"
        fixed = path.startswith("assets/")
        response.headers["Cache-Control"] = "max-age=31536000, immutable" if fixed else "no-cache"
        return response


def _mount_viewer(app: FastAPI, settings: Settings) -> None:
    if (settings.viewer_dir / "index.html").is_file():
        files = _ViewerFiles(settings)
        app.router.routes.append(_ViewerMount("/", files, name="viewer"))
        return

    @app.get("/", include_in_schema=False, response_class=PlainTextResponse)
    async def no_viewer() -> PlainTextResponse:
        return PlainTextResponse(_NOT_BUILT)


def _answer_errors(app: FastAPI) -> None:
    """Give every error the one shape."""

    @app.exception_handler(Refused)
    async def refused(_request: Request, error: Refused) -> Response:
        return json_response(error.body(), status=error.status, headers=error.headers)

    @app.exception_handler(RequestValidationError)
    async def invalid(request: Request, error: RequestValidationError) -> Response:
        media_type = request.headers.get("content-type", "")
        found = explain(list(error.errors()), error.body, media_type=media_type)
        body = error_body("invalid_body", found.message, known=found.known)
        return json_response(body, status=422)

    @app.exception_handler(HTTPException)
    async def http_error(request: Request, error: HTTPException) -> Response:
        phrase = HTTPStatus(error.status_code).phrase
        headers = dict(error.headers or {})
        message, path = str(error.detail), request.url.path
        if error.status_code == HTTPStatus.METHOD_NOT_ALLOWED:
            headers["Allow"] = ", ".join(_methods(app, path)) or "GET, HEAD"
            message = f"{request.method} is not understood there; send {headers['Allow']}"
        elif message == phrase:
            hint = did_you_mean(path, list(app.openapi()["paths"]))
            message = f"there is nothing at that address{hint or '; /docs lists every route'}"
        body = error_body(phrase.lower().replace(" ", "_"), message)
        return json_response(body, status=error.status_code, headers=headers)

    @app.exception_handler(Exception)
    async def failed(request: Request, error: Exception) -> Response:
        _LOG.error("a request failed", path=request.url.path, exc_info=error)
        message = "the service failed; its log says why"
        return json_response(error_body("internal", message), status=500)


def _methods(app: FastAPI, path: str) -> list[str]:
    """Return every method of a path; the router names those of one route only."""
    paths = app.openapi()["paths"]
    matching = [template for template in paths if compile_path(template)[0].fullmatch(path)]
    # `/clips/{clip}.glb` says more than `/clips/{clip}`, which matches its paths too.
    return sorted(method.upper() for method in paths[max(matching, key=len)]) if matching else []
