/* The walk of antnav.colony.kernels.walk in C, statement for statement, as a yardstick for the compiled Python. */
#include <stdint.h>
#include <string.h>

#define BATCH 64

static inline uint64_t mix(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
}

static uint64_t stream(uint64_t seed, uint64_t colony, uint64_t iteration, uint64_t ant) {
    uint64_t key = mix(seed + 0x9E3779B97F4A7C15ull);
    key = mix(key + colony);
    key = mix(key + iteration);
    return mix(key + ant);
}

static inline double uniform(uint64_t key, uint64_t draw) {
    return (double)(mix(key + draw * 0x9E3779B97F4A7C15ull) >> 11) * 0x1p-53;
}

/* n nodes, 8 slots; `path` and `slots` have n columns. Deadlock rule: retract while t <= switch, record every dead end. */
int64_t walk(int64_t n, const int32_t *neighbours, const uint8_t *reverse, const double *weight, uint64_t *visited,
             int32_t *path, uint8_t *slots, int64_t *steps_on_path, uint8_t *status, uint8_t *met_dead_end,
             int32_t *dead_count, uint64_t *dead_last, uint64_t *dead_pairs, int64_t start, int64_t goal, int64_t ants,
             int64_t retract, uint64_t seed, uint64_t colony, int64_t t) {
    int64_t alive[BATCH], cells[BATCH], depths[BATCH], draws[BATCH];
    uint64_t keys[BATCH];
    double running[8];
    int64_t moves = 0;
    for (int64_t first = 0; first < ants; first += BATCH) {
        int64_t count = ants - first < BATCH ? ants - first : BATCH;
        memset(visited, 0, n * sizeof *visited);
        visited[n] = ~0ull;
        for (int64_t a = 0; a < count; a++) {
            alive[a] = a;
            cells[a] = start;
            depths[a] = draws[a] = 0;
            keys[a] = stream(seed, colony, t, first + a);
            path[(first + a) * n] = start;
            status[first + a] = met_dead_end[first + a] = 0;
        }
        visited[start] = ~0ull;
        int64_t walking = count;
        while (walking > 0) {
            int64_t kept = 0;
            for (int64_t turn = 0; turn < walking; turn++) {
                int64_t a = alive[turn], ant = first + a, cell = cells[a], depth = depths[a];
                uint64_t bit = 1ull << a;
                draws[a]++;
                double total = 0;
                for (int k = 0; k < 8; k++) {
                    uint64_t free_ = 1 - ((visited[neighbours[cell * 8 + k]] >> a) & 1);
                    total += weight[cell * 8 + k] * (double)free_;
                    running[k] = total;
                }
                if (total > 0) {
                    double target = uniform(keys[a], draws[a]) * total;
                    int slot = 0;
                    for (int k = 0; k < 7; k++) slot += (target >= running[k]) & (running[k] < total);
                    cell = neighbours[cell * 8 + slot];
                    slots[ant * n + depth] = slot;
                    depth++;
                    path[ant * n + depth] = cell;
                    visited[cell] |= bit;
                    cells[a] = cell;
                    depths[a] = depth;
                    moves++;
                    if (cell == goal) {
                        status[ant] = 1;
                        steps_on_path[ant] = depth;
                        continue;
                    }
                } else {
                    met_dead_end[ant] = 1;
                    if (depth > 0) {
                        dead_count[cell]++;
                        uint64_t last = reverse[path[ant * n + depth - 1] * 8ll + slots[ant * n + depth - 1]];
                        if (depth > 1) {
                            uint64_t before = reverse[path[ant * n + depth - 2] * 8ll + slots[ant * n + depth - 2]];
                            dead_pairs[cell] |= 1ull << (last * 8 + before);
                        } else {
                            dead_last[cell] |= 1ull << last;
                        }
                    }
                    if (!retract || depth == 0) {
                        status[ant] = 2;
                        continue;
                    }
                    depths[a] = depth - 1;
                    cells[a] = path[ant * n + depth - 1];
                    moves++;
                }
                alive[kept++] = a;
            }
            walking = kept;
        }
    }
    return moves;
}
