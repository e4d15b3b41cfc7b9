"""A linear axis with dry friction, stepped; compiled."""

from twin.compilation.kernel import array_kernel


@array_kernel
def step_axis(transition, now, then, push, inputs, state, dry, moved):
    """Step an axis from input to input.

    Dry friction is what brings the axis to rest at the end of a step, as far as it can: it sticks
    below its limit and slides at it (the time-stepping rule of Moreau and Jean).

    Args:
        transition: State after a step by state before it, shape (k, k).
        now: State after a step by the inputs at its begin, shape (k, m).
        then: By the inputs at its end, shape (k, m).
        push: By a constant unit acceleration during it, shape (k,).
        inputs: Shape (n, m).
        state: At the first input, shape (k,).
        dry: Dry friction over mass [mm/s² or deg/s²].
        moved: Place of the axis's speed in the state.

    Returns:
        States at every input, shape (n, k).
    """
    steps, width, given = len(inputs), len(state), inputs.shape[1]
    states = inputs[:1, :1].repeat(steps * width).reshape(steps, width)
    states[0] = state
    for i in range(steps - 1):
        for a in range(width):
            value = 0.0
            for b in range(width):
                value += transition[a, b] * states[i, b]
            for b in range(given):
                value += now[a, b] * inputs[i, b] + then[a, b] * inputs[i + 1, b]
            states[i + 1, a] = value
        friction = -states[i + 1, moved] / push[moved]
        friction = min(max(friction, -dry), dry)
        for a in range(width):
            states[i + 1, a] += push[a] * friction
    return states


@array_kernel
def read_cubics(values, rises, places, late):
    """Values between inputs, read late, by cubics with the rates at both ends.

    Args:
        values: At the inputs, shape (n,).
        rises: Their rates times the step, shape (n,).
        places: Of the samples, in steps, shape (samples,).
        late: Delay, in steps.

    Returns:
        At the samples, shape (samples,).
    """
    last = len(values) - 1
    seen = places.copy()
    for i in range(len(seen)):
        place = min(max(places[i] - late, 0.0), float(last))
        before = min(int(place), last - 1)
        part = place - before
        rest = 1.0 - part
        seen[i] = (
            values[before] * (1.0 + 2.0 * part) * rest * rest
            + values[before + 1] * (3.0 - 2.0 * part) * part * part
            + (rises[before] * rest - rises[before + 1] * part) * part * rest
        )
    return seen
