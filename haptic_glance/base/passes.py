"""numba's passes for kernels that make no array: fewer of them, and no machine code for helpers.

Kernels and helpers keep their results bit for bit: the passes that are left out find nothing in them to change.
"""

from typing import Any

from numba.core.codegen import JITCodeLibrary
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


class NoMachineCode(FewerPasses):
    """The same for a function that is inlined into kernels: those alone become machine code."""

    def define_pipelines(self) -> list[PassManager]:
        """The passes, for code that is only linked."""
        self.state.library = LinkedCode(self.state.targetctx.codegen(), self.state.func_id.func_qualname)
        return super().define_pipelines()


class LinkedCode(JITCodeLibrary):
    """The code of a function that is inlined wherever it is called: optimised, but not executable by itself.

    Without its own optimisation a first run would take less time still, and simplification a few per cent more.
    """

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True

    @property
    def codegen(self) -> Any:
        """The object to which numba gives the environment of a function: none is needed for a linked one."""
        return self

    def set_env(self, env_name: str, env: object) -> None:
        """Ignores an environment, which the machine code of a function would look up."""
