"""Tickets by themselves: how long they last, how many there are, and where they lead."""

from __future__ import annotations

import pytest

from service.access import Access
from service.errors import Forbidden, QuotaExceeded
from service.tickets import Tickets, check_reach


def test_a_ticket_lasts_as_long_as_it_is_said_to() -> None:
    now = [100.0]
    tickets = Tickets(clock=lambda: now[0])
    token = tickets.issue("s", key="ada", role="read", seconds=5.0)
    now[0] = 104.9
    ticket = tickets.find(token)
    assert ticket is not None
    assert (ticket.session, ticket.key, ticket.role) == ("s", "ada", "read")
    assert tickets.find(token[:-1] + ("0" if token[-1] != "0" else "1")) is None
    now[0] = 105.0
    assert tickets.find(token) is None


def test_the_tickets_of_a_key_are_bounded_and_those_that_are_over_make_room() -> None:
    now = [0.0]
    tickets = Tickets(clock=lambda: now[0])
    for _ in range(1024):
        tickets.issue("s", key="ada", role="read", seconds=60.0)
    with pytest.raises(QuotaExceeded) as refused:
        tickets.issue("s", key="ada", role="read", seconds=60.0)
    assert refused.value.headers["Retry-After"] == "60"
    tickets.issue("s", key="bob", role="read", seconds=60.0)
    now[0] = 60.0
    tickets.issue("s", key="ada", role="read", seconds=60.0)


READS = [
    "/api/sessions/s",
    "/api/sessions/s.glb",
    "/api/sessions/s/stream",
    "/api/sessions/s/analysis",
    "/api/rigs/r",
    "/api/rigs/r.glb",
    "/api/rigs/r/surface.glb",
    "/api/rigs/r/textures/albedo.jpg",
    "/api/people",
    "/api/maps/arkit",
]
BEYOND = [
    "/api/sessions",
    "/api/sessions/",
    "/api/sessions/other",
    "/api/sessions/other.glb",
    "/api/sessions/ss",
    "/api/sessions/s.csv",
    "/api/sessions/s.glb/stream",
    "/api/rigs",
    "/api/rigs/r/expressions/12C.glb",
    "/api/clips",
    "/api/clips/s",
    "/metrics",
    "/mcp/",
    "/docs",
]


@pytest.mark.parametrize("commands", [False, True])
def test_a_ticket_leads_to_its_session_and_to_what_shows_it(commands: bool) -> None:
    access = Access("", session="s", commands=commands)
    for path in READS:
        check_reach(access, "GET", path)
    for path in BEYOND:
        for method in ("GET", "POST", "DELETE"):
            with pytest.raises(Forbidden):
                check_reach(access, method, path)


@pytest.mark.parametrize("method", ["PUT", "PATCH", "POST", "DELETE"])
def test_only_a_ticket_that_controls_commands_and_none_closes_or_issues(method: str) -> None:
    watching, moving = (Access("", session="s", commands=commands) for commands in (False, True))
    check_reach(moving, method, "/api/sessions/s/controls")
    with pytest.raises(Forbidden, match="control"):
        check_reach(watching, method, "/api/sessions/s/controls")
    for path in ("/api/sessions/s", "/api/sessions/s/tickets", "/api/rigs/r/inverse"):
        with pytest.raises(Forbidden):
            check_reach(moving, method, path)
