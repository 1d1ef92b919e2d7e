"""The studio: a local page on which a person looks at a mesh, simplifies it, touches it and marks it.

command.py   `haptic-glance studio`
guard.py     a viser server that only pages of this machine can use
app.py       Studio: the server, the files that it offers, a Window for each browser window
window.py    Window: the page of one person: its panels, messages and work in the background
session.py   Session: what a window holds, free of viser
specimen.py  Specimen: one mesh, and what was found on it
scene.py     Scene: what is drawn
panels/      what can be done, a file each
"""
