// tinygltf itself; cmake/colod.cmake says why it is compiled here.
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
