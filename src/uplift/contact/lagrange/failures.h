#pragma once
#include <string>
#include <vector>

#include "uplift/contact/kernel/kernel.h"
#include "uplift/contact/model.h"

namespace uplift {

/// Why the kernel failed, with the point named; `first` is the problem's row of the kernel's row 0.
std::string kernel_failure(const ContactModel&, const KernelReply&, std::ptrdiff_t first);
/// "points 3, 7 of 'footing'; point 1 of 'key'", at most `most` of them.
std::string point_names(const ContactModel&, const std::vector<std::ptrdiff_t>& rows, std::size_t most = 8);

}  // namespace uplift
