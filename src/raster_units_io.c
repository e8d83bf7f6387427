/* Units of height by name: what GDAL's drivers write, then whatever PROJ's database calls a length. */
#include "src/raster_parts_io.h"

#include <string.h>
#include <strings.h>

static const struct {
    const char *name;
    double metres;
} usual_units[] = {
    {"m", 1},
    {"metre", 1},
    {"metres", 1},
    {"meter", 1},
    {"meters", 1},
    {"m.", 1},
    {"ft", 0.3048},
    {"foot", 0.3048},
    {"feet", 0.3048},
    {"ft.", 0.3048},
    {"us-ft", 1200.0 / 3937},
    {"ftUS", 1200.0 / 3937},
    {"us_ft", 1200.0 / 3937},
    {"usft", 1200.0 / 3937},
    {"us ft", 1200.0 / 3937},
    {"survey foot", 1200.0 / 3937},
    {"us survey feet", 1200.0 / 3937},
    {"international foot", 0.3048},
    {"international feet", 0.3048},
    {"centimeter", 0.01},
    {"centimeters", 0.01},
    {"centimetres", 0.01},
    {"millimeter", 0.001},
    {"millimeters", 0.001},
    {"millimetres", 0.001},
    {"decimeter", 0.1},
    {"decimeters", 0.1},
    {"decimetres", 0.1},
    {"kilometer", 1000},
    {"kilometers", 1000},
    {"kilometres", 1000},
};

bool raster_unit_metres(PJ_CONTEXT *proj, const char *name, double *metres) {
    for (size_t i = 0; i < sizeof usual_units / sizeof *usual_units; i++)
        if (strcasecmp(name, usual_units[i].name) == 0) {
            *metres = usual_units[i].metres;
            return true;
        }
    int count = 0;
    bool found = false;
    PROJ_UNIT_INFO **units = proj_get_units_from_database(proj, NULL, "linear", FALSE, &count);
    for (int i = 0; i < count && !found; i++) {
        found = strcasecmp(name, units[i]->name) == 0 ||
                (units[i]->proj_short_name != NULL && strcasecmp(name, units[i]->proj_short_name) == 0);
        if (found) *metres = units[i]->conv_factor;
    }
    proj_unit_list_destroy(units);
    return found;
}
