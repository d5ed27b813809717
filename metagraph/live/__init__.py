"""The live session: what agents and engines ask while the character plays, over JSON lines, WebSocket and OSC."""
