"""The protocol's own client in Python starts a server, lists what it offers and calls some tools.

python mcp_sdk_client.py MODE CALLS.json COMMAND ...: MODE is "legacy", "auto" or a revision; CALLS has
[[name, arguments], ...]. Prints a line of JSON. Long jobs that the server makes tasks are waited for.
"""

from __future__ import annotations

import asyncio
import json
import sys
from pathlib import Path
from typing import Any, Literal

from mcp.client.client import Client
from mcp.client.extension import ClaimContext, ClientExtension, ResultClaim
from mcp.client.stdio import StdioServerParameters, stdio_client
from mcp_types import CallToolResult, Request, RequestParams, Result

polls: list[dict[str, Any]] = []  # what `tasks/get` told, in order


class TaskResult(Result):
    """A job that goes on after its answer."""

    result_type: Literal["task"] = "task"
    task_id: str
    status: str
    ttl_ms: int | None
    poll_interval_ms: int = 100


class TaskParams(RequestParams):
    """Which task is asked about."""

    task_id: str


class GetTask(Request[TaskParams, Literal["tasks/get"]]):
    """How far a task is."""

    method: Literal["tasks/get"] = "tasks/get"
    params: TaskParams


class TaskState(Result):
    """A task as it is now."""

    status: str
    status_message: str | None = None
    result: dict[str, Any] | None = None
    error: dict[str, Any] | None = None


class Tasks(ClientExtension):
    """Waits for tasks."""

    identifier = "io.modelcontextprotocol/tasks"

    def claims(self) -> list[ResultClaim[Any]]:
        return [ResultClaim(result_type="task", model=TaskResult, resolve=self.wait)]

    async def wait(self, made: TaskResult, context: ClaimContext) -> CallToolResult:
        while True:
            asked = GetTask(params=TaskParams(task_id=made.task_id))
            state = await context.session.send_request(asked, TaskState)
            polls.append({"status": state.status, "message": state.status_message})
            if state.status == "completed":
                return CallToolResult.model_validate(state.result)
            if state.status != "working":
                raise RuntimeError(f"{state.status}: {state.error}")
            await asyncio.sleep(made.poll_interval_ms / 1000)


async def main() -> None:
    mode, calls, command, *args = sys.argv[1:]
    heard: list[Any] = []

    async def progress(done: float, total: float | None, message: str | None) -> None:
        heard.append([done, total, message])

    transport = stdio_client(StdioServerParameters(command=command, args=args))
    extensions = [Tasks()] if mode != "legacy" else []
    async with Client(transport, mode=mode, extensions=extensions) as client:
        tools = (await client.list_tools()).tools
        resources = (await client.list_resources()).resources
        read = {r.uri: json.loads((await client.read_resource(r.uri)).contents[0].text) for r in resources}
        results = []
        watched = (
            client.listen(resource_subscriptions=[r.uri for r in resources]) if mode != "legacy" else None
        )
        if watched is not None:
            honoured = (await watched.__aenter__()).honored.resource_subscriptions
            await watched.__aexit__(None, None, None)
        for name, given in json.loads(Path(calls).read_text(encoding="utf-8")):
            done = await client.call_tool(name, given, progress_callback=progress)
            kinds = [content.type for content in done.content]
            results.append({"isError": done.is_error, "told": done.structured_content, "content": kinds})
        server = client.server_info
        told = {
            "revision": client.protocol_version,
            "name": server.name if server is not None else None,
            "instructions": client.instructions,
            "tools": {tool.name: tool.output_schema is not None for tool in tools},
            "resources": read,
            "results": results,
            "progress": heard,
            "honoured": honoured if watched is not None else None,
            "polls": polls,
        }
    print(json.dumps(told))


asyncio.run(main())
