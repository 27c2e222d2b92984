"""Tickets by themselves: how long they last, how many there are, and where they lead."""

from __future__ import annotations

import pytest

from service.access import Access
from service.errors import Forbidden, QuotaExceeded
from service.tickets import MAX_SECONDS, Tickets, check_reach


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


def test_a_page_that_is_asked_for_again_keeps_its_ticket() -> None:
    now = [0.0]
    tickets = Tickets(clock=lambda: now[0])
    first = tickets.of_page("s", key="ada")
    assert {tickets.of_page("s", key="ada") for _ in range(2000)} == {first}
    assert tickets.of_page("other", key="ada") != first
    assert tickets.of_page("s", key="bob") != first
    now[0] = 0.6 * MAX_SECONDS
    second = tickets.of_page("s", key="ada")
    assert second != first
    assert tickets.find(first) is not None  # A page that is open goes on.
    found = tickets.find(second)
    assert found is not None
    assert found.role == "control"
    now[0] = 3.0 * MAX_SECONDS
    assert tickets.of_page("s", key="ada") not in (first, second)
    assert list(tickets._of_pages) == [("s", "ada")]


def test_tickets_end_with_their_key_though_another_one_has_its_name() -> None:
    tickets = Tickets()
    hers, his, nobody = (
        tickets.issue("s", key=key, role="read", seconds=60.0) for key in ("ada", "bob", None)
    )
    page = tickets.of_page("s", key="ada")
    tickets.end_of({"ada"})
    assert tickets.find(hers) is None
    assert tickets.find(his) is not None
    assert tickets.of_page("s", key="ada") != page
    tickets.end_of({""})
    assert tickets.find(nobody) is None


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
