"""A process that photographs expressions, one after another, on the viewer's page.

Its arguments are the folder of the cache and that of the built viewer.
"""

from __future__ import annotations

import signal
import sys
from contextlib import ExitStack, suppress
from pathlib import Path

from .browser import NoBrowser
from .errors import NoPictures, Unprocessable
from .expression_orders import PictureOrder
from .priority import stay_back
from .stage import CallRefused, Stage
from .studio import NoViewer, studio
from .workbench import work


class _Photographer:
    """A studio, opened for the first picture."""

    def __init__(self, opened: ExitStack, folders: list[Path]) -> None:
        self._opened = opened
        self._folders = folders
        self._stage: Stage | None = None

    def picture(self, order: PictureOrder) -> bytes:
        """Return a PNG file.

        Raises:
            NoPictures: If there is nothing here to make it with.
            Unprocessable: If it cannot be had.
        """
        face = order.face
        try:
            stage = self._there()
            stage.enter(stage.derive(face.root, face.steps))
            return stage.photograph(face.frame(), face.rig().jaw, order.look)
        except (NoBrowser, NoViewer) as error:
            raise NoPictures("no_pictures", str(error)) from error
        except CallRefused as error:
            raise Unprocessable("cannot_be_drawn", str(error)) from error

    def _there(self) -> Stage:
        if self._stage is None:
            cache_dir, viewer_dir = self._folders
            opening = studio(cache_dir=cache_dir, viewer_dir=viewer_dir)
            self._stage = self._opened.enter_context(opening)
        return self._stage


def main() -> None:
    """Photograph until nobody orders any more, or in the middle of it it is told to end."""
    stay_back()
    # So that a browser, its profile and a folder are not left behind.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with suppress(KeyboardInterrupt), ExitStack() as opened:
        work(_Photographer(opened, [Path(folder) for folder in sys.argv[1:3]]).picture)


if __name__ == "__main__":
    main()
