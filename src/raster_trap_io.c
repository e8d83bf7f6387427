/* What GDAL and PROJ would print is kept for our own error line instead. */
#include "src/raster_parts_io.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <stdio.h>
#include <string.h>

static void CPL_STDCALL keep_first_failure(CPLErr severity, CPLErrorNum number, const char *text) {
    (void)number;
    struct raster_trap *trap = CPLGetErrorHandlerUserData();
    if (severity >= CE_Failure && trap->text[0] == '\0') snprintf(trap->text, sizeof trap->text, "%s", text);
}

void raster_trap_set(struct raster_trap *trap) {
    trap->text[0] = '\0';
    CPLPushErrorHandlerEx(keep_first_failure, trap);
}

void raster_trap_clear(void) {
    CPLPopErrorHandler();
}

enum scree_status raster_trap_fail(const struct raster_trap *trap, const char *what, struct scree_error *error) {
    const char *text = trap->text[0] != '\0' ? trap->text : "GDAL cannot read it";
    size_t length = strlen(what); /* GDAL often names it, too */
    while (strncmp(text, what, length) == 0 && strncmp(text + length, ": ", 2) == 0) text += length + 2;
    return scree_fail(error, SCREE_E_IO, "%s: %s", what, text);
}

bool raster_compound_ask(void) {
    if (CPLGetConfigOption("GTIFF_REPORT_COMPD_CS", NULL) != NULL) return false; /* somebody knows better */
    CPLSetThreadLocalConfigOption("GTIFF_REPORT_COMPD_CS", "YES");
    return true;
}

void raster_compound_leave(bool is_asked) {
    if (is_asked) CPLSetThreadLocalConfigOption("GTIFF_REPORT_COMPD_CS", NULL);
}

PJ_CONTEXT *raster_proj_new(void) {
    PJ_CONTEXT *proj = proj_context_create();
    if (proj != NULL) proj_log_level(proj, PJ_LOG_NONE);
    return proj;
}
