/* The methods of the literature by name: what each is good for, its options, and how it is run on a tile. Pure.
 *
 * Options are named as in the papers and have a value at every zoom. Written NAME=VALUE, where VALUE is
 *
 *     50            the same at all zooms
 *     0:50,5:20     a list: 50 from zoom 0 on, 20 from zoom 5 on
 *     400/2         a root value: 400 at zoom 0, half of it with each zoom
 *     4*2           4 at zoom 0, twice as much with each zoom
 *
 * The list of methods is in src/method_table.c: a new method is a line there. */
#ifndef SCREE_METHODS_H
#define SCREE_METHODS_H

#include "lod/method.h"
#include "src/lattice.h"
#include <stdbool.h>

#define METHOD_MAX_OPTIONS 12

struct method_option {
    const char *name;      /* as written before the = */
    const char *what;      /* one line for the help, with the unit */
    double least, most;    /* what is taken */
    double standard;       /* where none is given; NAN: none, the method is told NAN */
    double tolerance_part; /* where none is given and this is not 0: this part of the zoom's tolerance (--error) */
    bool is_whole;         /* rounded to whole numbers; else any number */
};

struct method {
    const char *name, *what; /* `what`: one line for the help */
    int option_count;
    const struct method_option *options;
    /* NULL where nothing is contradictory, else what is wrong with these values, one an option, in their order. */
    const char *(*contradiction)(const double values[]);
    enum scree_status (*run)(struct scree_memory *memory, const struct method_tile *tile, const double values[],
                             struct method_mesh *mesh, struct scree_error *error);
};

/* All of them; the last one has no name. */
extern const struct method method_table[];

/* What an option was set to. */
struct method_setting {
    int count; /* entries of the list; 0: it was not set */
    struct {
        int zoom;
        double value;
    } list[MAX_ZOOM + 1];
    double growth; /* the first entry's from zoom to zoom: 0.5, 1 or 2 */
};

/* A method with its options. */
struct method_choice {
    const struct method *method;
    struct method_setting settings[METHOD_MAX_OPTIONS];
};

/* SCREE_E_ARGUMENT when there is no such method; the line names all. */
enum scree_status method_choose(const char *name, struct method_choice *choice, struct scree_error *error);

/* Sets an option as in NAME=VALUE; a later one overrules. SCREE_E_ARGUMENT names the option and its range. */
enum scree_status method_set(struct method_choice *choice, const char *assignment, struct scree_error *error);

/* All options at a zoom whose tolerance is `tolerance_m`, one an option in their order. SCREE_E_ARGUMENT when one is
 * missing or out of its range there, or when they contradict one another. */
enum scree_status method_values_at(const struct method_choice *choice, int zoom, double tolerance_m,
                                   double values[METHOD_MAX_OPTIONS], struct scree_error *error);

/* Triangulates a tile with the values of its zoom. */
enum scree_status method_run(const struct method_choice *choice, int zoom, double tolerance_m,
                             struct scree_memory *memory, const struct method_tile *tile, struct method_mesh *mesh,
                             struct scree_error *error);

#endif
