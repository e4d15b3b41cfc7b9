"""What a block is compiled to: opcodes, registers, the assembler."""
