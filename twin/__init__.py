"""A digital twin of a 4-axis mill.

NC text flows one way through six rooms: ``nc`` reads it, ``toolpath`` knows its geometry,
``motion`` plans it, ``machine`` simulates it, ``compare`` judges it; ``cutting`` and ``render``
watch.
"""

__version__ = "0.1.0"
