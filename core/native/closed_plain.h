/* The steps of closed.c for any processor: edges one by one, row by row. */

/* Sorts out the edges between faces that look different ways, and those where a face is not known. */
static int32_t find(const sm_body *body, int32_t start, int32_t clusters, const eye *e, sm_work *work) {
    sm_edges *edges = &work->edges;
    uint32_t *restrict sure_list = edges->sure;
    uint64_t *restrict opens = edges->open, four = 0;
    int32_t n = 0;
    for (int32_t k = 0; k < clusters; k++) {
        int32_t cluster = work->runs[k];
        const float *restrict s = body->edge_sides + 128 * (size_t)cluster;
        const uint32_t *restrict ends = body->edge_ends + 16 * (size_t)cluster;
        float ex = e->at[0], ey = e->at[1], ez = e->at[2], margin = edges->margins[cluster - start];
        uint8_t backs[16], sures[16];
        uint32_t open = 0;
        for (int i = 0; i < 16; i++) {
            float a = s[i] * ex + s[16 + i] * ey + s[32 + i] * ez - s[48 + i];
            float b = s[64 + i] * ex + s[80 + i] * ey + s[96 + i] * ez - s[112 + i];
            int known = (fabsf(a) > margin) & (fabsf(b) > margin), back = a < 0.0f;
            backs[i] = (uint8_t)back;
            open |= (uint32_t)!known << i;
            sures[i] = (uint8_t)(known & (back ^ (b < 0.0f)));
        }
        for (int i = 0; i < 16; i++) {
            sure_list[n] = ends[i] | (uint32_t)backs[i] << 31;
            n += sures[i];
        }
        four = (k & 3 ? four : 0) | (uint64_t)open << 16 * (k & 3);
        opens[k >> 2] = four;
    }
    return n;
}

/* Where edges cross rows, and what they reach; those that cross none go. */
static extent take(int32_t front, int32_t n, const sm_picture *picture, sm_work *work) {
    const int64_t *restrict points = work->points;
    sm_edges *e = &work->edges;
    const uint32_t *restrict codes = e->sure;
    int32_t top = picture->top, bottom = picture->bottom, drawn = 0;
    int32_t first = bottom, last = top, left = INT32_MAX, right = INT32_MIN, crossings = 0;
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
        crossings += end - row;
    }
    return (extent){drawn, first, last, left >> 8, (right >> 8) + 1, crossings};
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
