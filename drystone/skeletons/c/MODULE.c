/* The collapse multiplier of a wall in which every block is carried by one joint: columns, piers, towers.
 *
 * Cut one joint of such a wall and all that it carries comes loose. Equilibrium of that part alone gives the forces of
 * the joint, x = x_dead + lambda x_live, so the least lambda at which a joint reaches its limit is the multiplier,
 * whatever the flow rule. Source: statics of a determinate structure; Heyman (1966) for the joint without tension.
 *
 * usage: method WALL.json RESULT.json, or method --describe */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *ABOUT =
    "{\"format\": \"describe/1\", \"name\": \"NAME\", \"version\": \"1.0\", \"licence\": \"MIT\",\n"
    " \"title\": \"determinate walls, in C\", \"tolerance\": 1e-9,\n"
    " \"traits\": {\"caption\": \"multiplier of a determinate wall\", \"seeks_least\": true}}\n";

/* The numbers of the array KEY in metadata.arrays; *count of them. The file is the one that Drystone writes. */
static double *numbers(const char *text, const char *key, int *count) {
    char quoted[40];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    const char *at = strstr(text, "\"arrays\":");
    if (at == NULL || (at = strstr(at, quoted)) == NULL) {
        fprintf(stderr, "the wall has no metadata.arrays.%s\n", key);
        exit(1);
    }
    at = strchr(at, '[');
    double *found = malloc((strlen(at) / 2 + 1) * sizeof *found);
    int depth = 0;
    *count = 0;
    do {
        char *end;
        double value = strtod(at, &end);
        if (end != at) found[(*count)++] = value, at = end;
        else depth += (*at == '[') - (*at == ']'), at++;
    } while (depth > 0);
    return found;
}

static void triples(FILE *file, const char *key, const double *value, int rows) {
    fprintf(file, ",\n \"%s\": [", key);
    for (int i = 0; i < rows; i++)
        fprintf(file, "%s[%.17g, %.17g, %.17g]", i ? ", " : "", value[3 * i], value[3 * i + 1], value[3 * i + 2]);
    fprintf(file, "]");
}

int main(int argc, char **argv) {
    if (argc == 2 && strcmp(argv[1], "--describe") == 0) return fputs(ABOUT, stdout) < 0;
    FILE *file = argc == 3 ? fopen(argv[1], "rb") : NULL;
    if (file == NULL) return fprintf(stderr, "usage: %s WALL.json RESULT.json\n", argv[0]), 1;
    fseek(file, 0, SEEK_END);
    long size = ftell(file);
    rewind(file);
    char *text = calloc(size + 1, 1);
    if (fread(text, 1, size, file) != (size_t)size) return fprintf(stderr, "%s cannot be read\n", argv[1]), 1;
    fclose(file);

    int n, m, k;
    double *fixed = numbers(text, "fixed", &n), *mu = numbers(text, "friction", &m);
    double *centre = numbers(text, "centroid", &k), *normal = numbers(text, "normal", &k);
    double *a = numbers(text, "block_a", &k), *b = numbers(text, "block_b", &k);
    double *end1 = numbers(text, "end1", &k), *end2 = numbers(text, "end2", &k);
    double *load[2] = {numbers(text, "dead", &k), numbers(text, "live", &k)};
    if ((file = fopen(argv[2], "w")) == NULL) return fprintf(stderr, "%s cannot be written\n", argv[2]), 1;

    /* Walk from the supports: the joint by which each free block is reached first carries it; a second one is too many. */
    int *order = calloc(n + 1, sizeof *order), *carrier = malloc(n * sizeof *carrier), reached = 0, free_blocks = 0;
    for (int i = 0; i < n; i++) {
        carrier[i] = -1;
        if (fixed[i]) order[reached++] = i;
        else free_blocks++;
    }
    for (int q = 0; q < reached && free_blocks == m; q++)
        for (int p = 0; p < m; p++) {
            int next = a[p] == order[q] ? (int)b[p] : b[p] == order[q] ? (int)a[p] : -1;
            if (next >= 0 && !fixed[next] && carrier[next] < 0 && carrier[order[q]] != p)
                carrier[next] = p, order[reached++] = next;
        }
    if (free_blocks != m || reached < n) {
        fprintf(file, "{\"format\": \"result/1\", \"status\": \"refused\", \"sentence\": \"It takes walls in which every "
                      "block is carried by one joint; this has %d free blocks and %d joints.\"}\n", free_blocks, m);
        return fclose(file);
    }

    /* Leaves first: loads of all that a joint carries, about the end of the joint, and the forces that balance them. */
    double *total[2], *force[2], least = INFINITY;
    int critical = -1, row = -1, falls = 0, pushed = 0;
    for (int l = 0; l < 2; l++) {
        total[l] = malloc(3 * n * sizeof(double)), force[l] = calloc(3 * m, sizeof(double));
        memcpy(total[l], load[l], 3 * n * sizeof(double));
    }
    for (int q = reached - 1; q >= 0 && carrier[order[q]] >= 0; q--) {
        int i = order[q], p = carrier[i], parent = a[p] == i ? (int)b[p] : (int)a[p];
        double side = b[p] == i ? 1.0 : -1.0, nx = normal[2 * p], ny = normal[2 * p + 1];
        double dx = end2[2 * p] - end1[2 * p], dy = end2[2 * p + 1] - end1[2 * p + 1], length = hypot(dx, dy);
        for (int l = 0; l < 2; l++) {
            double *f = total[l] + 3 * i, *x = force[l] + 3 * p;
            double about = f[2] + (centre[2 * i] - end1[2 * p]) * f[1] - (centre[2 * i + 1] - end1[2 * p + 1]) * f[0];
            double compression = -side * (f[0] * nx + f[1] * ny);
            x[1] = -side * about / (dx * ny - dy * nx);
            x[0] = compression - x[1];
            x[2] = -side * (f[0] * dx + f[1] * dy) / length;
            pushed |= l && (f[0] != 0.0 || f[1] != 0.0 || f[2] != 0.0);
            if (!fixed[parent]) {
                total[l][3 * parent] += f[0], total[l][3 * parent + 1] += f[1];
                total[l][3 * parent + 2] += f[2] + (centre[2 * i] - centre[2 * parent]) * f[1]
                                          - (centre[2 * i + 1] - centre[2 * parent + 1]) * f[0];
            }
        }
        double *x = force[0] + 3 * p, *y = force[1] + 3 * p;
        double dead[4] = {x[0], x[1], mu[p] * (x[0] + x[1]) + x[2], mu[p] * (x[0] + x[1]) - x[2]};
        double live[4] = {y[0], y[1], mu[p] * (y[0] + y[1]) + y[2], mu[p] * (y[0] + y[1]) - y[2]};
        double grain = 1e-12 * (fabs(x[0]) + fabs(x[1]) + fabs(x[2])); /* rounding of sums over the wall */
        for (int r = 0; r < 4; r++) {
            double at = dead[r] < -grain ? -1.0 : live[r] < 0.0 ? fmax(dead[r], 0.0) / -live[r] : INFINITY;
            if (at < least) least = at, critical = p, row = r;
        }
    }
    falls = least < 0.0;

    /* All that the critical joint carries moves: about the other end, or along the joint, lifting too if it proves a fall. */
    double *motion = calloc(3 * n, sizeof *motion);
    for (int q = 0; q < reached && critical >= 0; q++) {
        int i = order[q], p = critical, up = i;
        while (carrier[up] >= 0 && carrier[up] != p) up = a[carrier[up]] == up ? (int)b[carrier[up]] : (int)a[carrier[up]];
        if (carrier[up] != p) continue;
        double side = b[p] == up ? 1.0 : -1.0, *u = motion + 3 * i, *pivot = row == 0 ? end2 + 2 * p : end1 + 2 * p;
        double dx = end2[2 * p] - end1[2 * p], dy = end2[2 * p + 1] - end1[2 * p + 1], length = hypot(dx, dy);
        double turn = (dx * normal[2 * p + 1] - dy * normal[2 * p]) * side > 0.0 ? 1.0 : -1.0;
        if (row < 2) {
            u[2] = row == 0 ? -turn : turn;
            u[0] = -u[2] * (centre[2 * i + 1] - pivot[1]), u[1] = u[2] * (centre[2 * i] - pivot[0]);
        } else {
            double along = (row == 2 ? side : -side) / length, lift = falls ? side * mu[p] : 0.0;
            u[0] = along * dx + lift * normal[2 * p], u[1] = along * dy + lift * normal[2 * p + 1];
        }
    }
    const char *finding = falls ? "falls" : !pushed ? "stands" : critical < 0 ? "unbounded" : "collapses";
    fprintf(file, "{\"format\": \"result/1\", \"finding\": \"%s\", \"flow\": \"%s\"", finding, falls ? "associated" : "non-associated");
    if (falls || critical >= 0) triples(file, "mechanism", motion, n);
    if (critical >= 0 && !falls) {
        fprintf(file, ",\n \"multiplier\": %.17g", least);
        for (int j = 0; j < 3 * m; j++) force[0][j] += least * force[1][j];
    } else if (pushed && !falls) triples(file, "live_forces", force[1], m);
    if (!falls) triples(file, "forces", force[0], m);
    fprintf(file, ",\n \"sentence\": \"Every joint is statically determinate; the critical one is number %d.\"}\n", critical + 1);
    return fclose(file);
}
