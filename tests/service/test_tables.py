"""Markdown tables."""

from __future__ import annotations

import pytest

from service.tables import markdown_table


def test_a_table_has_its_head_a_rule_and_its_rows() -> None:
    lines = markdown_table(("muscle", "force"), [("risorius", 3), ("mentalis", "")])
    assert lines == ["| muscle | force |", "|---|---|", "| risorius | 3 |", "| mentalis |  |"]


def test_a_row_of_another_length_is_refused() -> None:
    with pytest.raises(ValueError, match="3 cells; expected 2"):
        markdown_table(("muscle", "force"), [("risorius", 3, 4)])
