/* The version of OpenMesh, for --version: its headers are C++, so that C asks through this door. Pure. */
#ifndef SCREE_OPENMESH_VERSION_H
#define SCREE_OPENMESH_VERSION_H

#ifdef __cplusplus
extern "C" {
#endif

struct openmesh_version {
    int version, major, minor;
};

struct openmesh_version openmesh_version(void);

#ifdef __cplusplus
}
#endif
#endif
