/* Gap and contact frame of the rings, for Siconos. The rotor's axis in a ring is at
   (q[0], q[1]) + factor (q[2], q[3]), if there are these; the rotor's angle is the last of q. */
#include <math.h>

static const double clearance = 3e-4, radius = 0.024;

static void axis(unsigned size, const double *q, double factor, double *at)
{
    at[0] = q[0], at[1] = q[1];
    if (size > 3)
        at[0] += factor * q[2], at[1] += factor * q[3];
}

static void gap(unsigned size, const double *q, double factor, double *y)
{
    double at[2];
    axis(size, q, factor, at);
    y[0] = clearance - hypot(at[0], at[1]);
}

/* Rows: along the inward normal; along the wall, with the spin. By columns. */
static void frame(unsigned size, const double *q, double factor, double *g)
{
    double at[2];
    axis(size, q, factor, at);
    const double distance = hypot(at[0], at[1]);
    const double nx = distance > 0.0 ? at[0] / distance : 0.0;
    const double ny = distance > 0.0 ? at[1] / distance : -1.0;
    g[0] = -nx, g[1] = -ny;
    g[2] = -ny, g[3] = nx;
    if (size > 3)
        for (int k = 0; k < 4; ++k)
            g[4 + k] = factor * g[k];
    g[2 * size - 2] = 0.0, g[2 * size - 1] = radius;
}

#define RING(name, factor)                                                                         \
    void h_##name(unsigned size, const double *q, unsigned m, double *y, unsigned n, double *z)    \
    {                                                                                              \
        gap(size, q, factor, y);                                                                   \
        (void)m, (void)n, (void)z;                                                                 \
    }                                                                                              \
    void G_##name(unsigned size, const double *q, unsigned m, double *g, unsigned n, double *z)    \
    {                                                                                              \
        frame(size, q, factor, g);                                                                 \
        (void)m, (void)n, (void)z;                                                                 \
    }

/* On the ring of the plane, on one that moves by (q[2], q[3]), and at the two ends. */
RING(fixed, 0.0)
RING(sprung, -1.0)
RING(left, -0.12)
RING(right, 0.12)
