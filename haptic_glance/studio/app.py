"""The studio's server: a window for each browser window that opens its page."""

from collections.abc import Sequence
from pathlib import Path

import viser

from .guard import HOST, LocalServer
from .session import Session
from .window import Window


class Studio:
    """Serves from its making on. files: what can be opened besides uploads; up: their axis, None for the files' own."""

    def __init__(self, files: Sequence[Path] = (), port: int = 0, up: str | None = None) -> None:
        self.files, self.up = list(files), up
        self.windows: dict[int, Window] = {}
        self.server = LocalServer(port, "Haptic Glance")
        self.server.gui.configure_theme(show_logo=False, show_share_button=False, control_width="large")
        self.server.gui.main_panel.dock_right()
        self.server.on_client_connect(self.connected)
        self.server.on_client_disconnect(self.gone)

    @property
    def address(self) -> str:
        """Where the page is."""
        return f"http://{HOST}:{self.server.get_port()}/"

    def connected(self, client: viser.ClientHandle) -> None:
        """A browser window has opened the page."""
        window = self.windows[client.client_id] = Window(client, self.files, self.up, Session())
        window.run("", window.start)

    def gone(self, client: viser.ClientHandle) -> None:
        """It was closed, or reloaded, or has lost the connection."""
        window = self.windows.pop(client.client_id, None)
        if window is not None:
            window.close()

    def stop(self) -> None:
        """Ends the server and all work."""
        for window in list(self.windows.values()):
            window.close()
        self.server.stop()
