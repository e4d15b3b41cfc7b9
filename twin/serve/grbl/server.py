"""The line itself: a TCP port, or a pseudo-terminal that senders open as a serial port."""

import asyncio
import contextlib
import os
import socket
import tty
from collections.abc import Iterator

from twin.serve.grbl.controller import GrblController
from twin.training.server.driver import Driver

PSEUDO_TERMINAL = "pty"
"""What is asked for in the place of a port."""
LOOK_S = 0.005
"""Period at which answers of the control are polled [s]."""
_AT_ONCE = 4096
_MOST_UNSENT = 1 << 20
"""Bytes that a sender may leave unread before its line is cut."""
_BUSY = b"[MSG:another sender is connected]\r\n"


class GrblLine:
    """One control behind one line.

    Args:
        driver: Lets the machine's time go on; lines are obeyed on its thread.
    """

    def __init__(self, driver: Driver) -> None:
        self._driver = driver
        self._control = GrblController(driver.session.room)
        self._taken = False

    async def work(self, data: bytes) -> bytes:
        """Pass bytes to the control; its answer."""
        control = self._control
        question = self._driver.inquire(lambda room: control.work(room, data))
        return await asyncio.wrap_future(question)

    async def greeting(self) -> bytes:
        """What a sender receives when it connects."""
        return await asyncio.wrap_future(
            self._driver.inquire(lambda _room: self._control.welcome())
        )

    async def serve(self, line: socket.socket | int) -> None:
        """Let a sender talk over a listening socket, or over this end of a pseudo-terminal."""
        if isinstance(line, int):
            await self.serve_terminal(line)
        else:
            await self.serve_port(line)

    async def serve_port(self, listener: socket.socket) -> None:
        """Let one sender at a time talk over TCP until this is cancelled."""
        server = await asyncio.start_server(self._talk, sock=listener)
        async with server:
            # Answers of a program that runs on are due though nobody listens.
            while True:
                await asyncio.sleep(LOOK_S)
                if not self._taken:
                    await self.work(b"")

    async def _talk(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        with contextlib.suppress(ConnectionError), contextlib.closing(writer):
            if self._taken:
                writer.write(_BUSY)
                await writer.drain()
                return
            self._taken = True
            try:
                writer.write(await self.greeting())
                await self._exchange(reader, writer)
            finally:
                self._taken = False

    async def _exchange(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Bytes to the control and back, until the sender goes or reads nothing any more."""
        coming = asyncio.ensure_future(reader.read(_AT_ONCE))
        try:
            while True:
                await asyncio.wait({coming}, timeout=LOOK_S)
                data = b""
                if coming.done():
                    data = coming.result()
                    if not data:
                        return
                    coming = asyncio.ensure_future(reader.read(_AT_ONCE))
                writer.write(await self.work(data))
                if writer.transport.get_write_buffer_size() > _MOST_UNSENT:
                    return
        finally:
            coming.cancel()

    async def serve_terminal(self, master: int) -> None:
        """Let a sender talk over a pseudo-terminal until this is cancelled."""
        os.set_blocking(master, False)
        coming = asyncio.Event()
        asyncio.get_running_loop().add_reader(master, coming.set)
        unsent = await self.greeting()
        try:
            while True:
                with contextlib.suppress(BlockingIOError):
                    unsent = unsent[os.write(master, unsent) :] if unsent else unsent
                with contextlib.suppress(TimeoutError):
                    await asyncio.wait_for(coming.wait(), LOOK_S)
                coming.clear()
                data = b""
                with contextlib.suppress(BlockingIOError):
                    data = os.read(master, _AT_ONCE)
                unsent = (unsent + await self.work(data))[-_MOST_UNSENT:]
        finally:
            asyncio.get_running_loop().remove_reader(master)


@contextlib.contextmanager
def pseudo_terminal() -> Iterator[tuple[int, str]]:
    """A pair of a terminal's ends: the file that the twin reads, and the path that a sender opens."""
    master, slave = os.openpty()
    try:
        tty.setraw(slave)
        # The slave stays open here: else the master ends with each sender.
        yield master, os.ttyname(slave)
    finally:
        os.close(master)
        os.close(slave)
