"""Build the library of kernels ahead of time, from the code that numba makes of them, for this very processor.

Numba's own compiler of extension modules (`numba.pycc`) takes any array for any other of the same item size. Entries of
the library look at the header of every array first, by the layout that NumPy keeps for C extensions (ndarraytypes.h).
"""

from __future__ import annotations

import hashlib
import json
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterable
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.core.boxing import unbox_tuple
from numba.core.codegen import AOTCodeLibrary, AOTCPUCodegen
from numba.core.cpu import CPUContext
from numba.core.dispatcher import Dispatcher
from numba.core.errors import NumbaError
from numba.core.types.containers import BaseTuple, Tuple
from numba.extending import NativeValue, models, register_model, unbox

from methods.numerics import built

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # numba means to replace it one day; the lock holds the version that has it
    from numba.pycc import CC
    from numba.pycc.compiler import ModuleCompiler
    from numba.pycc.platform import external_compiler_works
    from setuptools.errors import BaseError, CCompilerError

BYTE, WORD, POINTER = ir.IntType(8), ir.IntType(32), ir.IntType(8).as_pointer()
OBJECT = ir.LiteralStructType([ir.IntType(64), POINTER])
"""PyObject: references, type."""
DESCRIPTION = ir.LiteralStructType([OBJECT, POINTER, BYTE, BYTE, BYTE, BYTE, WORD])
"""Head of PyArray_Descr: class of the items, kind, type, byte order, one unused, number of the type."""
ARRAY = ir.LiteralStructType([OBJECT, POINTER, WORD, POINTER, POINTER, POINTER, DESCRIPTION.as_pointer(), WORD])
"""PyArrayObject: data, dimensions, shape, strides, base, description, flags."""


class CannotBuild(Exception):
    """The library cannot be built here; the message says why."""


class Arguments(Tuple):  # type: ignore[misc]
    """A tuple of arguments whose arrays are what their types say."""

    def __new__(cls, _types: Iterable[Any]) -> Any:
        """A tuple with a type for each item, even where all are the same."""
        return object.__new__(cls)


register_model(Arguments)(models.TupleModel)


@unbox(Arguments)  # type: ignore[untyped-decorator]
def _checked(kind: Arguments, given: Any, c: Any) -> Any:
    """Take the arguments out of the tuple of a call, after a look at each array."""
    value = cgutils.alloca_once(c.builder, c.context.get_value_type(kind))
    failed = cgutils.alloca_once_value(c.builder, cgutils.true_bit)
    with ExitStack() as stack:

        def refuse_unless(right: Any) -> None:
            with cgutils.early_exit_if(c.builder, stack, c.builder.not_(right)):
                c.pyapi.err_set_string("PyExc_TypeError", "arguments of another kind")

        _look_at_tuple(kind, given, c, refuse_unless)
        native = unbox_tuple(kind, given, c)
        c.builder.store(native.value, value)
        c.builder.store(native.is_error, failed)
    return NativeValue(c.builder.load(value), is_error=c.builder.load(failed))


def _look_at_tuple(kind: BaseTuple, given: Any, c: Any, refuse_unless: Callable[[Any], None]) -> None:
    """Length of a tuple, and all arrays in it."""
    count = c.pyapi.tuple_size(given)  # -1 of what is no tuple
    refuse_unless(c.builder.icmp_signed("==", count, count.type(len(kind))))
    for place, item in enumerate(kind):
        if isinstance(item, types.Array):
            _look_at_array(item, c.pyapi.tuple_getitem(given, place), c, refuse_unless)
        elif isinstance(item, BaseTuple):
            _look_at_tuple(item, c.pyapi.tuple_getitem(given, place), c, refuse_unless)


def _look_at_array(kind: types.Array, given: Any, c: Any, refuse_unless: Callable[[Any], None]) -> None:
    """Class, dimensions, layout and items of one array."""
    builder = c.builder

    def field(record: Any, *path: int) -> Any:
        return builder.load(builder.gep(record, [WORD(0), *map(WORD, path)]))

    array = builder.bitcast(given, ARRAY.as_pointer())
    refuse_unless(builder.icmp_unsigned("==", field(array, 0, 1), _array_class(c)))
    refuse_unless(builder.icmp_signed("==", field(array, 2), WORD(kind.ndim)))
    needed = WORD(0x1 | 0x100 | 0x400)  # NPY_ARRAY_C_CONTIGUOUS, NPY_ARRAY_ALIGNED, NPY_ARRAY_WRITEABLE
    refuse_unless(builder.icmp_signed("==", builder.and_(field(array, 7), needed), needed))
    items, wanted = field(array, 6), np.dtype(str(kind.dtype))
    refuse_unless(builder.icmp_signed("==", field(items, 6), WORD(wanted.num)))
    refuse_unless(builder.icmp_signed("==", field(items, 4), BYTE(ord(wanted.byteorder))))


def _array_class(c: Any) -> Any:
    """The address of numpy.ndarray, looked up at the first call."""
    module = c.builder.module
    slot = module.globals.get("numpy_ndarray")
    if slot is None:
        slot = cgutils.add_global_variable(module, POINTER, "numpy_ndarray")
        slot.initializer, slot.linkage = POINTER(None), "internal"
    with c.builder.if_then(cgutils.is_null(c.builder, c.builder.load(slot)), likely=False):
        numpy = c.pyapi.import_module(c.context.insert_const_string(module, "numpy"))
        found = c.pyapi.object_getattr_string(numpy, "ndarray")
        c.builder.store(c.builder.bitcast(found, POINTER), slot)
        c.pyapi.decref(numpy)
    return c.builder.load(slot)


class _AsOptimised(AOTCodeLibrary):  # type: ignore[misc]
    """Entries optimised by themselves; a second pass over the kernels would change the order of loose sums."""

    def finalize(self) -> None:
        """Optimise what is there so far, and link the kernels as they are."""
        super()._optimize_final_module()
        super().finalize()

    def _optimize_final_module(self) -> None:
        pass


class _ThisProcessor(AOTCPUCodegen):  # type: ignore[misc]
    """Code for the abilities that numba finds when it compiles in a process, so that the bits are the same."""

    _library_class = _AsOptimised

    def _customize_tm_features(self) -> str:
        features: str = self._get_host_cpu_features()
        return features


class _Target(CPUContext):  # type: ignore[misc]
    """Numba takes the address of an exception's class for the class, which holds in a process of its own only."""

    def get_c_value(self, builder: Any, typ: Any, name: str, dllimport: bool = False) -> Any:
        place = super().get_c_value(builder, typ, name, dllimport)
        if not name.startswith("PyExc_"):
            return place
        return builder.load(builder.bitcast(place, typ.as_pointer().as_pointer()))


class _Library(CC):  # type: ignore[misc]
    def _compile_object_files(self, build_dir: str) -> tuple[list[str], list[str]]:
        compiler = ModuleCompiler(self._export_entries, self.name, self.use_nrt, cpu_name="host")
        target = compiler.context.subtarget(_internal_codegen=_ThisProcessor(self.name, "host"), aot_mode=True)
        target.__class__ = _Target
        compiler.context = target
        compiler.external_init_function = self._init_function
        place = str(Path(build_dir) / "kernels.o")
        compiler.write_native_object(place, wrap=True)
        return [place], compiler.dll_exports


def build(kernels: Iterable[Dispatcher]) -> Path:
    """Build the library of all kernels that were called, each for the arguments it was called with.

    Args:
        kernels: of numba; those that others call need no call of their own.

    Returns:
        the list beside the library, which is written last.

    Raises:
        CannotBuild: there is no compiler of C, a kernel was called in two ways, or the folder takes no file.
    """
    if not external_compiler_works():
        raise CannotBuild("there is no compiler of C")
    library = _Library(built.NAME, source_module=__name__)
    modules = set()
    for kernel in kernels:
        modules.add(kernel.py_func.__module__)
        # Constants are what compiled code passes, never a call from outside.
        called = [each for each in kernel.signatures if not any(isinstance(kind, types.Literal) for kind in each)]
        if len(called) > 1:
            raise CannotBuild(f"{kernel.py_func.__qualname__} is called with arguments of several kinds")
        for arguments in called:
            returned = kernel.overloads[arguments].signature.return_type
            library.export(built.symbol(kernel.py_func), returned(Arguments(arguments)))(_entry(kernel))
    told = {"conditions": built.conditions(), "sources": {name: built.digest(name) for name in sorted(modules)}}
    stamp = hashlib.sha256(json.dumps(told).encode()).hexdigest()[:16]
    file = built.FOLDER / f"{built.NAME}.{sys.implementation.cache_tag}-{stamp}.so"
    try:
        built.FOLDER.mkdir(exist_ok=True)
        with tempfile.TemporaryDirectory(dir=built.FOLDER) as folder:
            library.output_dir, library.output_file = folder, file.name
            library.compile()
            draft = Path(folder, built.LIST.name)
            draft.write_text(json.dumps({"file": file.name} | told, indent=1), encoding="utf-8")
            Path(folder, file.name).replace(file)
            draft.replace(built.LIST)
    except (OSError, BaseError, CCompilerError, NumbaError) as error:
        raise CannotBuild(f"{type(error).__name__}: {error}") from error
    for other in built.FOLDER.glob(f"{built.NAME}.{sys.implementation.cache_tag}-*.so"):
        if other != file:
            other.unlink(missing_ok=True)  # of earlier sources; a process that has loaded it keeps it
    return built.LIST


def _entry(kernel: Dispatcher) -> Callable[[Any], Any]:
    return lambda arguments: kernel(*arguments)
