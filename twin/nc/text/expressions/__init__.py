"""Expressions: their text, their trees and what they compute."""
