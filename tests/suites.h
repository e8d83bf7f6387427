/* Every suite of tests/run, one a line: SUITE(area) calls suite_area() of tests/test_area.c, which adds its CUnit suite
 * to the registry and returns 0. Without a SUITE of the includer's own, this declares them. */
#ifndef SUITE
#define SUITE(area) int suite_##area(void);
#endif

SUITE(vocabulary)
SUITE(fractal)
SUITE(greedy)
SUITE(grid_error)
SUITE(hausdorff)
SUITE(cursor)
SUITE(stream_header)
SUITE(codec)
SUITE(mesh)
SUITE(border)
SUITE(simplify)
SUITE(strip)
SUITE(hostile)
SUITE(tile)
SUITE(decode)
SUITE(terrain)
SUITE(store)
SUITE(layer)
SUITE(scree_json)
SUITE(stream_product)
SUITE(verify)
SUITE(lattice)
SUITE(raster)
SUITE(raster_bad)
SUITE(raster_datum)
SUITE(raster_globe)
SUITE(raster_mosaic)
SUITE(extract)
SUITE(against)
SUITE(pyramid)
SUITE(rungs)
SUITE(stitch)
SUITE(stitch_build)
SUITE(select)
SUITE(playback)
SUITE(player)

#undef SUITE
