"""The live session: what agents and engines ask while the character plays, over JSON lines, WebSocket and
OSC.
"""

PORT, OSC_PORT = 8765, 8766  # of WebSocket and of OSC, where none is given
VMC_PORT = 39539  # where programs that receive VMC listen by default
FACE_PORT = 11111  # where Unreal listens for Live Link Face
