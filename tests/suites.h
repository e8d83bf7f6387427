/* Every suite of tests/run, one a line: SUITE(area) calls suite_area() of tests/test_area.c, which adds its CUnit suite
 * to the registry and returns 0. Included several times, each time with another SUITE. */
SUITE(vocabulary)
