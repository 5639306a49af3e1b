"""Many jobs: in this process, in several local ones, or on a Dask cluster; the same plan gives the same bits.

- ``plan``, ``choices``: what is asked for, as data; every combination of exemplars, methods, seeds and sizes.
- ``parcels``, ``orders``: a job in pieces that can travel; inputs travel once, by their hash.
- ``places``, ``processes``, ``cluster``: where orders are carried out, behind one interface.
- ``folder``, ``pictures``, ``report``, ``page``: what is kept on disk, and what was done already.
- ``running``: a plan from its start to its report; ``run_jobs`` for jobs without a plan.
"""
