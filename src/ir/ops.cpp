#include "ir/ops.h"

namespace shaderx::ir {

static constexpr OpInfo kOpInfo[] = {
#define OP(name, text, operands, rule) {text, operands, TypeRule::rule},
#include "ir/ops.def"
#undef OP
};

static constexpr ContextInfo kContextInfo[] = {
#define CONTEXT(name, text, type, source, host) {text, Type::type, ContextSource::source, host},
#include "ir/context.def"
#undef CONTEXT
};

const OpInfo& info(Op op) { return kOpInfo[static_cast<int>(op)]; }
const ContextInfo& info(Context c) { return kContextInfo[static_cast<int>(c)]; }

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
