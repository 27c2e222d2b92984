"""The tools as the Model Context Protocol shows and calls them; imports its package, 0.4 s."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import structlog
from mcp.server.context import ServerRequestContext
from mcp.server.lowlevel import Server
from mcp.server.streamable_http_manager import StreamableHTTPSessionManager
from mcp.shared.exceptions import MCPError
from mcp_types import (
    INVALID_PARAMS,
    CallToolRequestParams,
    CallToolResult,
    ContentBlock,
    ListToolsResult,
    PaginatedRequestParams,
    ResourceLink,
    TextContent,
    ToolAnnotations,
)
from mcp_types import Tool as ShownTool
from pydantic import BaseModel, ValidationError
from starlette.requests import Request

from engine import Rig

from ..components import Components, parts_of
from ..errors import Refused, Unprocessable, error_body
from ..explaining import explain
from ..version import version
from .answered import ExportedClip
from .caller import Caller, owner_named
from .tool import Tool
from .tools import INSTRUCTIONS, TOOLS

_LOG = structlog.get_logger("agents")
_KNOWN_SHOWN = 30
"""Names that an error lists; the nearest come first."""
_GLB = "model/gltf-binary"
_SIDED = r"^(AU|[LRTB])?\d{1,2}$"

Context = ServerRequestContext[Any, Request]


def manager_of(parts: Components, rig: Rig) -> StreamableHTTPSessionManager:
    """Return what answers requests; it keeps nothing from one to the next.

    Args:
        parts: Of the service.
        rig: Whose action units the schemas name.
    """
    shown = [_shown(tool, rig) for tool in TOOLS]
    by_name = {tool.name: tool for tool in TOOLS}

    async def list_tools(
        _context: Context, _params: PaginatedRequestParams | None
    ) -> ListToolsResult:
        return ListToolsResult(tools=shown)

    async def call_tool(context: Context, params: CallToolRequestParams) -> CallToolResult:
        tool = by_name.get(params.name)
        if tool is None:
            message = f"there is no tool {params.name!r}; there are {', '.join(by_name)}"
            raise MCPError(code=INVALID_PARAMS, message=message)
        seen = await parts_of(_request(context).scope)
        return await _called(tool, params.arguments or {}, seen, _caller(context))

    server: Server[Any] = Server(
        "risorius",
        title="Risorius",
        version=version(),
        description="A physically simulated face, driven by FACS.",
        instructions=INSTRUCTIONS,
        on_list_tools=list_tools,
        on_call_tool=call_tool,
    )
    return StreamableHTTPSessionManager(
        server,
        json_response=True,
        stateless=True,
        # Hosts, origins and keys are the guard's, which stands in front of every route.
        security_settings=None,
        max_request_body_size=parts.settings.max_body_bytes,
    )


def _shown(tool: Tool, rig: Rig) -> ShownTool:
    """Return a tool as clients list it."""
    asks = tool.asks.model_json_schema()
    if "action_units" in asks["properties"]:
        (units,) = (s for s in asks["properties"]["action_units"]["anyOf"] if s["type"] == "object")
        names = [*rig.action_units]
        units["propertyNames"] = {"anyOf": [{"enum": names}, {"pattern": _SIDED}]}
    return ShownTool(
        name=tool.name,
        title=tool.title,
        description=tool.description,
        input_schema=asks,
        output_schema=tool.answers.model_json_schema(mode="serialization"),
        annotations=ToolAnnotations(
            title=tool.title,
            read_only_hint=tool.reads_only,
            destructive_hint=False,
            idempotent_hint=tool.repeats,
            open_world_hint=False,
        ),
    )


async def _called(
    tool: Tool, arguments: Mapping[str, Any], parts: Components, caller: Caller
) -> CallToolResult:
    """Do what a tool does; what is refused is an answer that a model can act on."""
    try:
        answer = await tool.run(_asked(tool, arguments), parts, caller)
    except Refused as refused:
        return _failed(refused)
    except Exception as error:
        _LOG.error("a tool failed", tool=tool.name, exc_info=error)
        return _failed(Refused("internal", "the service failed; its log says why"))
    return CallToolResult(
        content=_content(answer), structured_content=answer.model_dump(mode="json")
    )


def _asked(tool: Tool, arguments: Mapping[str, Any]) -> BaseModel:
    """Return a tool's arguments; models send null for what they leave out.

    Raises:
        Unprocessable: In the words of the API.
    """
    given = {name: value for name, value in arguments.items() if value is not None}
    try:
        return tool.asks.model_validate(given)
    except ValidationError as error:
        found = explain(error.errors(), given)
        raise Unprocessable("invalid_arguments", found.message, known=found.known) from error


def _content(answer: BaseModel) -> list[ContentBlock]:
    """Return an answer as text, for clients that read no structure, and what it links to."""
    content: list[ContentBlock] = [TextContent(text=answer.model_dump_json())]
    if isinstance(answer, ExportedClip) and answer.status == "done":
        link = ResourceLink(
            uri=answer.url,
            name=f"{answer.clip_id}.glb",
            title="Animated face",
            mime_type=_GLB,
            size=answer.bytes,
        )
        content.append(link)
    return content


def _failed(refused: Refused) -> CallToolResult:
    """Return the API's error body, its names as far as a model reads them."""
    known: Sequence[str] | None = refused.known
    body = error_body(refused.error, refused.message, known=known and known[:_KNOWN_SHOWN])
    return CallToolResult(content=[TextContent(text=json.dumps(body))], is_error=True)


def _caller(context: Context) -> Caller:
    """Return who calls: by the name it gave with the request, or when the connection began."""
    client = context.session.client_params
    name = client.client_info.name if client is not None else None
    return Caller(owner_named(name), str(_request(context).base_url).rstrip("/"))


def _request(context: Context) -> Request:
    assert context.request is not None  # Every message comes over HTTP.
    return context.request
