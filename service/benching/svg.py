"""A small writer of SVG: shapes and words in two themes, on a card of its own."""

from __future__ import annotations

from html import escape

_STYLE = """
text { font: 12px -apple-system, "Segoe UI", "Noto Sans", Helvetica, Arial, sans-serif; }
.card { fill: #ffffff; stroke: #d1d9e0; }
.ink { fill: #1f2328; } .quiet { fill: #59636e; } .title { font-size: 14px; font-weight: 600; }
.axis { stroke: #818b98; fill: none; } .grid { stroke: #e4e8ec; fill: none; }
.ours { fill: #0969da; } .other { fill: #afb8c1; } .second { fill: #bc4c00; }
.ours-line { stroke: #0969da; fill: none; stroke-width: 2.5; }
.second-line { stroke: #bc4c00; fill: none; stroke-width: 2; }
.other-line { stroke: #818b98; fill: none; stroke-width: 1.5; stroke-dasharray: 5 4; }
@media (prefers-color-scheme: dark) {
.card { fill: #0d1117; stroke: #3d444d; }
.ink { fill: #f0f6fc; } .quiet { fill: #9198a1; }
.axis { stroke: #656c76; } .grid { stroke: #21262d; }
.ours { fill: #4493f8; } .other { fill: #656c76; } .second { fill: #f0883e; }
.ours-line { stroke: #4493f8; } .second-line { stroke: #f0883e; }
.other-line { stroke: #9198a1; }
}
""".strip()


class Drawing:
    """Shapes from left to right and top to bottom, pixels; `kind` names a class of the style.

    Text has a card behind it in the colours of the reader's theme, so that it can be read whatever
    the page around it looks like.
    """

    def __init__(self, width: int, height: int, title: str) -> None:
        self._width, self._height, self._title = width, height, title
        self._shapes: list[str] = []

    def text(self, x: float, y: float, words: str, kind: str = "ink", *, at: str = "start") -> None:
        """Write `words` on the line at `y`, from, around or up to `x` (start, middle, end)."""
        self._shapes.append(
            f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{at}" class="{kind}">'
            f"{escape(words)}</text>"
        )

    def bar(self, x: float, y: float, width: float, height: float, kind: str) -> None:
        """Fill a rectangle."""
        self._shapes.append(
            f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}" rx="2" '
            f'class="{kind}"/>'
        )

    def dot(self, x: float, y: float, kind: str) -> None:
        """Fill a small disc."""
        self._shapes.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" class="{kind}"/>')

    def line(self, places: list[tuple[float, float]], kind: str) -> None:
        """Draw straight from each place to the next."""
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
        self._shapes.append(f'<polyline points="{path}" class="{kind}"/>')

    def written(self) -> str:
        """Return the file."""
        w, h = self._width, self._height
        return "\n".join(
            [
                f'<svg xmlns="http://www.w3.org/2000/svg" width="{w}" height="{h}" '
                f'viewBox="0 0 {w} {h}" role="img">',
                f"<title>{escape(self._title)}</title>",
                f"<style>{_STYLE}</style>",
                f'<rect x="0.5" y="0.5" width="{w - 1}" height="{h - 1}" rx="8" class="card"/>',
                *self._shapes,
                "</svg>",
                "",
            ]
        )
