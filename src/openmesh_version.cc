#include "src/openmesh_version.h"

#include <OpenMesh/Core/System/config.h>

struct openmesh_version openmesh_version(void) {
    return {OM_GET_VER, OM_GET_MAJ, OM_GET_MIN}; /* as OpenMesh names them: version, major, minor */
}
