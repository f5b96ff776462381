"""Coefficients of the module `real::coefficients`: minimax polynomials by Remez exchange, 50 digits.

    pip install mpmath
    python3 docs/know/polynomials.py

Prints each polynomial from the constant term up, and the largest error of its function before the coefficients are
rounded. The error is relative, but absolute for the cosine.
"""

import mpmath as mp

mp.mp.dps = 50
GRID = 2000


def odd_part(function, lead):
    """(function(x)/x - lead)/x^2 over z = x^2."""

    def quotient(z):
        x = mp.sqrt(z)
        return (function(x) / x - lead) / z

    return quotient


def cosine_part(z):
    """(cos x - 1 + z/2)/z^2 over z = x^2."""
    return (mp.cos(mp.sqrt(z)) - 1 + z / 2) / z**2


def minimax(target, weight, top, terms):
    """Polynomial of `terms` coefficients with the least largest weight(z) |p(z) - target(z)| on (0, top]."""
    nodes = [top * (1 - mp.cos(mp.pi * (k + mp.mpf(1) / 2) / (terms + 1))) / 2 for k in range(terms + 1)]
    grid = [top * (1 - mp.cos(mp.pi * (k + 1) / GRID)) / 2 for k in range(GRID)]
    wanted = [target(z) for z in grid]
    for _ in range(12):
        matrix = mp.matrix(terms + 1, terms + 1)
        right = mp.matrix(terms + 1, 1)
        for row, z in enumerate(nodes):
            for power in range(terms):
                matrix[row, power] = z**power
            matrix[row, terms] = (-1) ** row / weight(z)
            right[row] = target(z)
        coefficients = list(mp.lu_solve(matrix, right))[:terms]
        error = [weight(z) * (mp.polyval(coefficients[::-1], z) - f) for z, f in zip(grid, wanted)]
        nodes = alternation(grid, error, terms + 1)
    return coefficients, max(abs(e) for e in error)


def alternation(grid, error, count):
    """Places of the largest error in each run of one sign."""
    runs = []
    for z, e in zip(grid, error):
        if runs and (runs[-1][1] > 0) == (e > 0):
            if abs(e) > abs(runs[-1][1]):
                runs[-1] = (z, e)
        else:
            runs.append((z, e))
    if len(runs) != count:
        raise ArithmeticError(f"{len(runs)} runs of one sign, not {count}")
    return [z for z, _ in runs]


EIGHTH, QUARTER = mp.tan(mp.pi / 8) ** 2, (mp.pi / 4) ** 2
LOGARITHM = ((mp.sqrt(2) - 1) / (mp.sqrt(2) + 1)) ** 2
SINE = (odd_part(mp.sin, 1), lambda z: z, QUARTER)
COSINE = (cosine_part, lambda z: z**2, QUARTER)
ARCTANGENT = (odd_part(mp.atan, 1), lambda z: z, EIGHTH)
AREA_TANGENT = (odd_part(lambda s: 2 * mp.atanh(s), 2), lambda z: z / 2, LOGARITHM)

for name, function, terms in [("sin", SINE, 3), ("cos", COSINE, 3), ("atan", ARCTANGENT, 4), ("ln", AREA_TANGENT, 3)]:
    coefficients, error = minimax(*function, terms)
    print(f"{name}, {terms} terms: {mp.nstr(error, 2)}")
    for value in coefficients:
        print("   ", mp.nstr(value, 9))
