"""The words of a block that is being compiled."""

import dataclasses
from collections.abc import Set

from twin.nc.bytecode.assembler import UnsupportedError
from twin.nc.control.control import Control
from twin.nc.functions import SPINDLE_STARTS
from twin.nc.text.blocks import Word


@dataclasses.dataclass(slots=True)
class BlockWords:
    """The words of one block that nothing has taken yet, besides G and M.

    Attributes:
        control: Whose block it is.
        words: By address.
        codes: Numbers of its G codes, in the order in which they take effect.
        functions: Numbers of its M functions, in the order of the text.
        functions_act: One of them does more than being reported.
        acting_letters: Addresses of words that do something by themselves, such as S and T.
    """

    control: Control
    words: dict[str, Word]
    codes: tuple[int, ...]
    functions: tuple[int, ...]
    functions_act: bool
    acting_letters: Set[str]

    def take(self, address: str) -> Word | None:
        """Take a word; None where there is none."""
        return self.words.pop(address, None)

    def take_axes(self) -> list[tuple[int, Word]]:
        """Take the words that name axes; pairs of column and word.

        Raises:
            UnsupportedError: The machine lacks one of them.
        """
        taken: list[tuple[int, Word]] = []
        for address in [each for each in self.words if each in self.control.axis_letters]:
            index = self.control.axis_index.get(address)
            if index is None:
                raise UnsupportedError
            taken.append((index, self.words.pop(address)))
        return taken

    def starts_spindle(self) -> bool:
        """An M function of the block carries the speed."""
        return any(f"M{number}" in SPINDLE_STARTS for number in self.functions)
