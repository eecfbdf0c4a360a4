"""Options of the compiler: one set for each kind of kernel."""

# Kernels borrow arrays. Reference counting at every call took a fifth of the time of a map, so it is off.
KERNEL = dict(
    nogil=True,
    error_model="numpy",
    no_cfunc_wrapper=True,
    forceinline=False,
    _nrt=False,
)
# Internal kernels are called by kernels only. They have no wrapper for Python, which takes as long to compile
# as the kernel itself. A call from Python would end the process.
INTERNAL = dict(KERNEL, no_cpython_wrapper=True)
KERNEL_INLINE = dict(KERNEL, forceinline=True)
INTERNAL_INLINE = dict(INTERNAL, forceinline=True)
# Kernels that are called seldom stay functions. In the body of a caller they would take registers from what runs always.
SELDOM = dict(KERNEL, seldom=True)
# Entry points that run long. Each is optimised in a module of its own, where what it alone calls becomes part of its body. The
# lanes need this: in the module of the other kernels their small functions are not inlined.
LONG = dict(KERNEL, long=True)
