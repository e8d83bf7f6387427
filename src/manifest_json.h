/* What the manifests of both products, layer.json and scree.json, say in the same way. Pure. */
#ifndef SCREE_MANIFEST_JSON_H
#define SCREE_MANIFEST_JSON_H

#include "src/json_text.h"
#include "src/lattice.h"
#include <stddef.h>
#include <stdint.h>

/* A zoom's tiles, sorted by y, then x, as a list of the fewest rectangles that joining equal runs of rows gives:
 * objects of startX, startY, endX, endY, inclusive. Without memory `json` is failed. */
void manifest_put_ranges(struct json_text *json, const struct tile_id *tiles, uint32_t count);

/* "projection": "EPSG:4326" in the geodetic profile; else the authority's code of the CRS, or the WKT where it has
 * none, or "none". */
void manifest_put_projection(struct json_text *json, const struct lattice *lattice, const char *crs_wkt);

/* Four numbers under a key. */
void manifest_put_rectangle(struct json_text *json, const char *key, const double rectangle[4]);

/* "bounds": those of the data, on the globe cut to what clients know. */
void manifest_put_bounds(struct json_text *json, const struct lattice *lattice, const double data_bounds[4]);

/* "lattice": all that lattice_geodetic or lattice_local was given. */
void manifest_put_lattice(struct json_text *json, const struct lattice *lattice);

/* Hashes the bytes that tell two builds apart (FNV-1a): begin with MANIFEST_HASH. */
#define MANIFEST_HASH UINT64_C(0xcbf29ce484222325)
uint64_t manifest_mix(uint64_t hash, const void *bytes, size_t size_bytes);

/* "version": "1.0.0-" and eight hexadecimal digits of the hash. */
void manifest_put_version(struct json_text *json, uint64_t hash);

#endif
