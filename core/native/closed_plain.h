/* The steps of closed.c for any processor: edges one by one, row by row. */

static inline int32_t x_of(int64_t point) { return (int32_t)point; }
static inline int32_t y_of(int64_t point) { return (int32_t)(point >> 32); }

/* Sorts out the edges between faces that look different ways, and those where a face is not known. */
static int32_t find(const sm_body *body, int32_t start, int32_t clusters, const eye *e, int32_t *open, sm_work *work) {
    sm_edges *edges = &work->edges;
    uint32_t *restrict sures = edges->sure;
    int32_t *restrict opens = edges->open, n = 0, m = 0;
    for (int32_t k = 0; k < clusters; k++) {
        int32_t cluster = work->runs[k];
        const float *restrict s = body->edge_sides + 128 * (size_t)cluster;
        const uint32_t *restrict ends = body->edge_ends + 16 * (size_t)cluster;
        float ex = e->at[0], ey = e->at[1], ez = e->at[2], margin = edges->margins[cluster - start];
        uint32_t unknown = 0;
        uint8_t backs[16], drawn[16];
        for (int i = 0; i < 16; i++) {
            float a = s[i] * ex + s[16 + i] * ey + s[32 + i] * ez - s[48 + i];
            float b = s[64 + i] * ex + s[80 + i] * ey + s[96 + i] * ez - s[112 + i];
            int known = (fabsf(a) > margin) & (fabsf(b) > margin), back = a < 0.0f;
            backs[i] = (uint8_t)back;
            unknown |= (uint32_t)!known << i;
            drawn[i] = (uint8_t)(known & (back ^ (b < 0.0f)));
        }
        for (int i = 0; i < 16; i++) {
            sures[n] = ends[i] | (uint32_t)backs[i] << 31;
            n += drawn[i];
        }
        for (; unknown; unknown &= unknown - 1) opens[m++] = 16 * cluster + __builtin_ctz(unknown);
    }
    *open = m;
    return n;
}

/* Keeps those of the open edges whose faces look different ways by their snapped areas. */
static int32_t settle(const sm_body *body, int32_t front, int32_t n, int32_t open, sm_work *work) {
    const int64_t *restrict points = work->points;
    uint32_t *restrict sure = work->edges.sure;
    for (int32_t k = 0; k < open; k++) {
        const int32_t *c = body->edge_corners + 4 * (size_t)work->edges.open[k];
        int64_t p = points[c[0]], q = points[c[1]], r = points[c[2]], s = points[c[3]];
        int64_t dx = x_of(q) - x_of(p), dy = y_of(q) - y_of(p);
        int64_t one = dx * (y_of(r) - y_of(p)) - dy * (x_of(r) - x_of(p));
        int64_t other = dy * (x_of(s) - x_of(p)) - dx * (y_of(s) - y_of(p));
        int first = front * one > 0, second = front * other > 0;
        sure[n] = (uint32_t)(c[0] | c[1] << 16) | (uint32_t)!first << 31;
        n += first ^ second;
    }
    return n;
}

/* Where edges cross rows, and what they reach; those that cross none go. */
static extent take(int32_t front, int32_t n, const sm_picture *picture, sm_work *work) {
    const int64_t *restrict points = work->points;
    sm_edges *e = &work->edges;
    const uint32_t *restrict codes = e->sure;
    int32_t top = picture->top, bottom = picture->bottom, drawn = 0;
    int32_t first = bottom, last = top, left = INT32_MAX, right = INT32_MIN;
    int32_t *restrict rows = e->row, *restrict ends = e->end;
    uint64_t *restrict at = e->at, *restrict slopes = e->slope, *restrict minus = e->minus;
    for (int32_t i = 0; i < n; i++) {
        int64_t p = points[codes[i] & 0x7fff], q = points[codes[i] >> 16 & 0x7fff], above = p < q ? p : q, below = p < q ? q : p;
        int32_t row = first_row(y_of(above)), end = first_row(y_of(below)), xa = x_of(above), xb = x_of(below);
        row = row < top ? top : row;
        end = end > bottom ? bottom : end;
        if (row >= end) continue;
        double inverse = 1.0 / (y_of(below) - y_of(above)), slope = (xb - xa) * inverse;
        double crossing = (xa + (256.0 * row - y_of(above)) * slope) * 0x1p-8 + 1.0 - inverse * 0x1p-9;
        rows[drawn] = row;
        ends[drawn] = end;
        at[drawn] = (uint64_t)(int64_t)(crossing * 0x1p46);
        slopes[drawn] = (uint64_t)(int64_t)((end - row > 1 ? slope : 0.0) * 0x1p46);
        minus[drawn++] = (uint64_t)-(int64_t)((codes[i] >> 31) ^ (p <= q) ^ (front < 0));
        first = row < first ? row : first;
        last = end > last ? end : last;
        left = xa < left ? xa : left;
        left = xb < left ? xb : left;
        right = xa > right ? xa : right;
        right = xb > right ? xb : right;
    }
    return (extent){drawn, first, last, left >> 8, (right >> 8) + 1};
}

/* Steps all bits right of every crossing, in the word of each row whose first bit is column `left`. */
static inline void step(int32_t n, int32_t word, int32_t left, int planes, int counted, sm_edges *e) {
    size_t start = e->rows * (size_t)word;
    uint64_t *restrict p0 = e->planes[0] + start, *restrict p1 = e->planes[1] + start, *restrict p2 = e->planes[2] + start;
    uint64_t *restrict counts = e->counts;
    for (int32_t i = 0; i < n; i++) {
        uint64_t at = e->at[i] - ((uint64_t)left << FRACTION), slope = e->slope[i], minus = e->minus[i];
        for (int32_t row = e->row[i], end = e->end[i]; row < end; row++, at += slope) {
            int64_t x = (int64_t)at >> FRACTION;
            uint64_t bits = x < 0 ? ~0ull : x > 63 ? 0 : ~0ull << (x & 63), was = p0[row], carry = (was ^ minus) & bits;
            p0[row] = was ^ bits;
            if (planes == 3) p2[row] ^= (p1[row] ^ minus) & carry;
            p1[row] ^= carry;
            if (counted) counts[row]++;
        }
    }
}

/* The most crossings of a row; counts fall back to 0. */
static uint64_t most_crossings(const extent *all, sm_edges *e) {
    uint64_t most = 0, *restrict counts = e->counts + all->top;
    WHOLE_BLOCKS for (int32_t i = 0; i < up_to(all->bottom - all->top, BLOCK); i++) {
        most = counts[i] > most ? counts[i] : most;
        counts[i] = 0;
    }
    return most;
}

/* Moves a word of the window, whose first bit is column `left`, into the picture; rows come in blocks,
 * as those without crossings change nothing. */
static inline void add_word(const extent *all, int32_t word, int32_t left, int planes, sm_picture *picture, sm_edges *e) {
    size_t start = e->rows * (size_t)word + (size_t)all->top;
    uint64_t *restrict p0 = e->planes[0] + start, *restrict p1 = e->planes[1] + start, *restrict p2 = e->planes[2] + start;
    int shift = left & 63, rest = picture->width - left, spills = shift && (all->right - 1) >> 6 > left >> 6;
    uint64_t keep = rest < 64 ? ~0ull >> (64 - rest) : ~0ull;
    uint64_t *restrict one = picture->bits + (size_t)picture->height * (size_t)(left >> 6) + all->top, *restrict two = one + picture->height;
    int32_t n = up_to(all->bottom - all->top, BLOCK);
    WHOLE_BLOCKS for (int32_t i = 0; i < n; i++) {
        uint64_t bits = (p0[i] | p1[i] | (planes == 3 ? p2[i] : 0)) & keep;
        one[i] |= bits << shift;
        p0[i] = bits;
        p1[i] = 0;
        if (planes == 3) p2[i] = 0;
    }
    if (spills)
        WHOLE_BLOCKS for (int32_t i = 0; i < n; i++) two[i] |= p0[i] >> (64 - shift);
    WHOLE_BLOCKS for (int32_t i = 0; i < n; i++) p0[i] = 0;
}

/* Back to 0, in `words` columns of words. */
static void clear(const extent *all, int32_t words, sm_edges *e) {
    for (int p = 0; p < 3; p++)
        for (int32_t w = 0; w < words; w++)
            memset(e->planes[p] + e->rows * (size_t)w + all->top, 0, 8 * (size_t)(all->bottom - all->top));
}

/* Draws what lies inside the crossings; returns 0 where a row has too many. */
static int cover(const extent *all, sm_picture *picture, sm_edges *e) {
    int32_t left = all->left, words = (all->right - left + 63) / 64;
    for (int32_t w = 0; w < words; w++) step(all->n, w, left + 64 * w, 2, w == 0, e);
    uint64_t most = most_crossings(all, e);
    if (most > MOST_OF_TWO) clear(all, words, e);
    if (most > MOST_OF_THREE) return 0;
    for (int32_t w = 0; w < words; w++) {
        if (most > MOST_OF_TWO) {
            step(all->n, w, left + 64 * w, 3, 0, e);
            add_word(all, w, left + 64 * w, 3, picture, e);
        } else {
            add_word(all, w, left + 64 * w, 2, picture, e);
        }
    }
    return 1;
}
