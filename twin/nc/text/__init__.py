"""From bytes to blocks: lines, words, expressions, diagnostics."""
