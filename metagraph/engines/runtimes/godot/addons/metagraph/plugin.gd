@tool
extends EditorPlugin
# The node MetagraphCharacter is known by its class name; the editor needs nothing else.
