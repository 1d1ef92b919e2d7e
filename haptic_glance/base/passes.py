"""numba's passes for kernels that make no array, and for their helpers: fewer of them.

Kernels and helpers keep their results bit for bit: the passes that are left out find nothing in them to change.
"""

from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import PassManager

# Each pass walks through the whole function, and after most of them numba finds out anew where variables live. Our
# kernels have no closures, comprehensions, `with`, literal_unroll, expressions of arrays or overloads to inline.
LEFT_OUT = {
    "with_lifting", "inline_closure_likes", "rewrite_semantic_constants", "Rewrite dynamic raises",
    "make_function_op_code_to_jit_function", "inline_inlinables", "find_literally", "literal_unroll",
    "LiteralPropagation", "inline_overloads", "nopython_rewrites", "dump_parfor_diagnostics",
}  # fmt: skip


class FewerPasses(CompilerBase):
    """numba's compiler of a function that makes no array."""

    def define_pipelines(self) -> list[PassManager]:
        """numba's passes for compiled functions, each once, without those that are left out."""
        passes, added = PassManager("haptic_glance"), set(LEFT_OUT)
        for step, text in DefaultPassBuilder.define_nopython_pipeline(self.state).passes:
            if step.name() not in added:
                passes.add_pass(step, text)
                added.add(step.name())
        passes.finalize()
        return [passes]
