"""An agent over the Model Context Protocol: it opens a face, feels, winks, looks, and exports.

python docs/examples/mcp_agent.py [URL] [--seconds 3]
"""

import argparse
import asyncio
import os
from typing import Any

import httpx2
from mcp import Client
from mcp.client.streamable_http import streamable_http_client
from mcp_types import Implementation, TextContent

KEY = os.environ.get("RISORIUS_API_KEY", "")  # Where the service asks for one.
NAME = Implementation(name="example-agent", version="1")  # Its commands are held under this name.


async def call(agent: Client, tool: str, **arguments: Any) -> dict[str, Any]:
    """Call a tool and return what it answers; what is refused says why, and what is known."""
    answer = await agent.call_tool(tool, arguments)
    if answer.is_error or answer.structured_content is None:
        said = [block.text for block in answer.content if isinstance(block, TextContent)]
        raise SystemExit(f"{tool}: {' '.join(said)}")
    for warning in answer.structured_content.get("warnings", []):
        print("  warning:", warning)
    return answer.structured_content


async def perform(url: str, seconds: float) -> None:
    """Do what an agent would that is told good news."""
    http = httpx2.AsyncClient(headers={"X-API-Key": KEY}, timeout=120)
    there = streamable_http_client(f"{url}/mcp/", http_client=http)
    async with http, Client(there, client_info=NAME) as agent:
        print("tools:", ", ".join(tool.name for tool in (await agent.list_tools()).tools))
        face = await call(agent, "open_face")
        print("watch it:", face["viewer_url"])
        me = {"session_id": face["session_id"]}
        felt = await call(agent, "set_emotion", label="amused", fade_in=0.4, **me)
        print(f"{felt['label']} plays {felt['recipe']}: {felt['source']}")
        # With keep it is added to what was set; 40 is a code that no face here has.
        units = await call(agent, "set_action_units", facs="L46E+40", keep=True, **me)
        print("held now:", units["facs"])
        await asyncio.sleep(seconds)
        seen = await call(agent, "get_state", **me)
        writers = [writer for layer in seen["layers"] for writer in layer["writers"]]
        print("seen:", seen["facs"], "by", [f"{w['owner']}: {w['emotion']}" for w in writers])
        clip = await call(agent, "export_clip", last=seconds, fps=15, **me)
        while clip["next_step"] is not None:
            clip = await call(agent, "export_clip", clip_id=clip["clip_id"])
        print(f"{clip['frames']} frames of what it did: {clip['url']}")


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("url", nargs="?", default="http://127.0.0.1:8000")
parser.add_argument("--seconds", type=float, default=3.0, help="how long the face is held")
asked = parser.parse_args()
asyncio.run(perform(asked.url, asked.seconds))
