/* Gap and contact frame of the drop, for Siconos. */
#include <math.h>

static const double clearance = 3e-4, radius = 0.024;

void h(unsigned size_of_q, const double *q, unsigned size_of_y, double *y, unsigned size_of_z,
       double *z)
{
    y[0] = clearance - hypot(q[0], q[1]);
    (void)size_of_q, (void)size_of_y, (void)size_of_z, (void)z;
}

/* Rows: along the inward normal; along the wall, with the spin. By columns. */
void G(unsigned size_of_q, const double *q, unsigned size_of_y, double *g, unsigned size_of_z,
       double *z)
{
    const double distance = hypot(q[0], q[1]);
    const double nx = distance > 0.0 ? q[0] / distance : 0.0;
    const double ny = distance > 0.0 ? q[1] / distance : -1.0;
    g[0] = -nx, g[1] = -ny;
    g[2] = -ny, g[3] = nx;
    g[4] = 0.0, g[5] = radius;
    (void)size_of_q, (void)size_of_y, (void)size_of_z, (void)z;
}
