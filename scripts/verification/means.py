"""Welch's test of all means of pictures of two renderers. Pictures are stacked: rounds of other seeds first."""

import functools

import numpy as np


def blocks(pictures, size):
    """Means of squares of `size` pixels; rounds first, channels last."""
    n, height, width, channels = pictures.shape
    return pictures.reshape(n, height // size, size, width // size, size, channels).mean(axis=(2, 4))


@functools.cache
def tail(degrees):
    """Angles, and the two-sided p of the t whose tangent over the root of the degrees of freedom they are.

    The density of Student's distribution, with t = tan(angle) sqrt(degrees): its tail is an integral of cos^(degrees - 1)."""
    grid = np.linspace(0.0, np.pi / 2, 20001)
    steps = np.exp((degrees - 1) * np.log(np.maximum(np.cos(0.5 * (grid[1:] + grid[:-1])), 1e-300)))
    sums = np.append(np.cumsum(steps[::-1])[::-1], 0.0)
    return grid, sums / sums[0]


def count_variance(theirs, samples):
    """The least variance that a mean of `samples` of ours has from round to round, whatever the rounds show.

    They are stratified: of them those beyond an edge, or those that survive roulette, are one of two neighbouring whole numbers. A few
    rounds may all have the same one, and say nothing of the other; the variance of such a number is up to a quarter. A sample counts
    as much as the mean there, or of the picture if that is more."""
    reference = np.abs(theirs.mean(axis=0))
    typical = np.abs(theirs).mean(axis=tuple(range(theirs.ndim - 1)))
    return (np.maximum(reference, typical) / samples) ** 2 / 4.0


def p_values(ours, theirs, slack, least_variance):
    """Two-sided p of each mean, by Welch's test with the degrees of freedom of Welch and Satterthwaite, rounded down. Differences
    up to `slack` are none; `least_variance` of a round of ours."""
    parts = [np.maximum(a.var(axis=0, ddof=1), least) / len(a) for a, least in ((ours, np.maximum(least_variance, 1e-30)), (theirs, 1e-30))]
    t = np.maximum(np.abs(ours.mean(axis=0) - theirs.mean(axis=0)) - slack, 0.0) / np.sqrt(parts[0] + parts[1])
    degrees = (parts[0] + parts[1]) ** 2 / (parts[0] ** 2 / (len(ours) - 1) + parts[1] ** 2 / (len(theirs) - 1))
    degrees = np.floor(degrees).astype(int)
    p = np.ones_like(t)
    for d in np.unique(degrees):
        here = degrees == d
        p[here] = np.interp(np.arctan(t[here] / np.sqrt(d)), *tail(int(d)))
    return p
