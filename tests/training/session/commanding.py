"""Commands to a session, as its tests give them."""

from twin.training.session.session import SceneSession


def do(session: SceneSession, what: str, /, **arguments: object) -> None:
    """Give a command that is taken, and let the machine go on."""
    assert session.submit({"do": what, **arguments}), session.refusal
    session.advance()


def refused(session: SceneSession, what: str, /, **arguments: object) -> str:
    """Give a command that is refused; the reason."""
    assert not session.submit({"do": what, **arguments})
    return session.refusal
