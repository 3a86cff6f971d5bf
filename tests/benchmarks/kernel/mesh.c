/* Bytes to triangles: balls, open, dented or doubled, and soups. */
#include "fuzz.h"

#include <math.h>
#include <string.h>

static void read_vertex(reader *r, double size, float *at) {
    for (int i = 0; i < 3; i++) at[i] = (float)read_number(r, size);
}

/* Onto a grid that may fall on the centres of pixels. */
static void round_vertices(mesh *m) {
    for (int32_t v = 0; v < m->vertices; v++)
        for (int i = 0; i < 3; i++) m->at[v][i] = rintf(m->at[v][i] * 32.0f) / 32.0f;
}

static void add_face(mesh *m, int32_t a, int32_t b, int32_t c) {
    if (m->faces == MOST_FACES) return;
    int32_t *corners = m->corners[m->faces++];
    corners[0] = a, corners[1] = b, corners[2] = c;
}

/* A ball of rings, closed but for the faces that are left out. */
static void read_ball(reader *r, double size, mesh *m) {
    int32_t rings = 1 + (int32_t)read_below(r, 9), around = 3 + (int32_t)read_below(r, 22);
    double bumps = read_below(r, 4) ? 0.0 : 0.3;
    m->vertices = rings * around + 2;
    for (int32_t v = 0; v < m->vertices; v++) {
        int32_t ring = v == 0 ? 0 : v == m->vertices - 1 ? rings + 1 : 1 + (v - 1) / around;
        double polar = 3.14159265358979 * ring / (rings + 1), turn = 6.28318530717959 * ((v - 1) % around) / around;
        double radius = size * (bumps > 0.0 ? 1.0 + read_number(r, bumps) : 1.0);
        m->at[v][0] = (float)(radius * sin(polar) * cos(turn));
        m->at[v][1] = (float)(radius * sin(polar) * sin(turn));
        m->at[v][2] = (float)(radius * cos(polar));
    }
    int32_t last = m->vertices - 1;
    for (int32_t k = 0; k < around; k++) {
        int32_t n = (k + 1) % around, low = last - around;
        add_face(m, 0, 1 + k, 1 + n);
        add_face(m, last, low + n, low + k);
        for (int32_t ring = 0; ring + 1 < rings; ring++) {
            int32_t a = 1 + ring * around, b = a + around;
            add_face(m, a + k, b + k, b + n);
            add_face(m, a + k, b + n, a + n);
        }
    }
}

static void read_soup(reader *r, double size, mesh *m) {
    m->vertices = 1 + (int32_t)read_below(r, 40);
    for (int32_t v = 0; v < m->vertices; v++) read_vertex(r, size, m->at[v]);
    uint32_t n = (uint32_t)m->vertices;
    for (uint32_t faces = read_below(r, 80); faces; faces--) {
        int32_t a = (int32_t)read_below(r, n), b = (int32_t)read_below(r, n), c = (int32_t)read_below(r, n);
        add_face(m, a, b, c);
    }
}

void read_mesh(reader *r, mesh *m) {
    static const double sizes[] = {0.2, 0.5, 0.02, 0.001, 3.0, 40.0, 1e4, 1e-5};
    double size = sizes[read_below(r, 8)];
    uint32_t kind = read_byte(r);
    m->vertices = m->faces = 0;
    if (kind & 1) read_soup(r, size, m);
    else if (kind != 2) read_ball(r, size, m);
    if (kind & 8) round_vertices(m);
    for (uint32_t n = kind & 4 ? read_below(r, 5) : 0; n && m->faces; n--) {
        uint32_t face = (read_byte(r) << 8 | read_byte(r)) % (uint32_t)m->faces, how = read_below(r, 5);
        int32_t *c = m->corners[face], other = (int32_t)read_below(r, (uint32_t)m->vertices);
        if (how == 0) memcpy(c, m->corners[--m->faces], sizeof *m->corners); /* left out */
        if (how == 1) add_face(m, c[0], c[1], c[2]);                         /* twice */
        if (how == 2) add_face(m, c[2], c[1], c[0]);                         /* and turned over */
        if (how == 3) memcpy(m->at[c[0]], m->at[other], sizeof *m->at);      /* without area, perhaps */
        if (how == 4) c[1] = other;
    }
}
