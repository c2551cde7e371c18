# find_package(uplift): the target uplift::uplift, the C interface of the library.
include(${CMAKE_CURRENT_LIST_DIR}/uplift-targets.cmake)
