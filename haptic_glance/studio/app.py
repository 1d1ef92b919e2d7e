"""The studio's server: a window for each browser window that opens its page."""

import time
import uuid

import viser

from .guard import HOST, LocalServer
from .opening import THEME
from .session import Session, Settings
from .window import Window

ITEM = "haptic-glance-sessions"  # in the browser's local storage: the sessions that its windows have had
LEFT = 4  # sessions without a window that are kept for a page that comes back
SECONDS = 5  # that a browser may take to say which they are
GOING = 20  # tenths of a second until a second window of a browser is taken for one beside the first


class Studio:
    """Serves from its making on. port: 0 takes any free one."""

    def __init__(self, settings: Settings, port: int = 0) -> None:
        self.settings = settings
        self.windows: dict[int, tuple[str, Window]] = {}  # client -> name of its session, window
        self.left: dict[str, Session] = {}
        self.server = LocalServer(port, "Haptic Glance")
        self.server.gui.configure_theme(**THEME)
        self.server.on_client_connect(self.connected)
        self.server.on_client_disconnect(self.gone)

    @property
    def address(self) -> str:
        """The address of the page, with its token."""
        return f"http://{HOST}:{self.server.get_port()}/?token={self.server.token}"

    def connected(self, client: viser.ClientHandle) -> None:
        """A browser window has opened the page, or comes back after a reload or a lost connection."""
        name, session = self.session_of(client)
        window = Window(client, self.settings, session)
        self.windows[client.client_id] = name, window
        window.run("", window.start)

    def session_of(self, client: viser.ClientHandle) -> tuple[str, Session]:
        """(name, Session) that a window of this browser has left last, or a new one."""
        try:
            names = (client.local_storage.get_item(ITEM, SECONDS) or "").split()
        except (RuntimeError, TimeoutError):  # a browser that stores nothing
            names = []
        for _ in range(GOING):  # a page may be back before the server knows that it was gone
            name = next((name for name in reversed(self.left) if name in names), None)
            if name is not None:
                return name, self.left.pop(name)
            if not {name for name, _ in list(self.windows.values())} & {*names}:
                break
            time.sleep(0.1)
        name = uuid.uuid4().hex
        client.local_storage.set_item(ITEM, " ".join([*names, name][-4 * LEFT :]))
        return name, Session()

    def gone(self, client: viser.ClientHandle) -> None:
        """A window was closed or reloaded, or has lost the connection: its session waits for it."""
        name, window = self.windows.pop(client.client_id, ("", None))
        if window is not None:
            window.close()
            self.left = dict([*self.left.items(), (name, window.session)][-LEFT:])

    def stop(self) -> None:
        """Ends the server and all work."""
        for _, window in list(self.windows.values()):
            window.close()
        self.server.stop()
