#include "ir/ops.h"

namespace shaderx::ir {

bool opNamed(std::string_view name, Op& op) {
    for (int i = 0; i < kOps; i++)
        if (kOpInfo[i].name == name) {
            op = static_cast<Op>(i);
            return true;
        }
    return false;
}

bool contextNamed(std::string_view name, Context& c) {
    for (int i = 0; i < kContexts; i++)
        if (kContextInfo[i].name == name) {
            c = static_cast<Context>(i);
            return true;
        }
    return false;
}

}  // namespace shaderx::ir
