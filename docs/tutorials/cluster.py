"""
Run it on a cluster
===================

The pipeline's objects, trainings and splits are pieces of work that do not depend on each other. With ``parallel=dask``
they go to the workers of a dask cluster, and the results are the same bytes. The machines share no folder: the input
files of a piece are sent to the worker, and its files and rows come back.

This page is not run when it is built, since it needs a cluster. The tests check that its code is valid and that the
settings exist.

Needs a clone and ``pip install '.[cluster]'``; its code runs without a network. The pipeline fetches its meshes:
``python -m stages.meshes household`` does so beforehand.
"""

import os
import shutil

from dask.distributed import Client

# sphinx_gallery_thumbnail_path = "../reports/figures/pipeline.png"

# %%
# By hand
# -------
#
# On each machine ``pip install '.[cluster]'``, in the same version; an error names both versions if they differ. Then:
#
# .. code-block:: sh
#
#    dask scheduler                                           # on one machine; prints its address
#    dask worker tcp://HOST:8786 --nworkers 16 --nthreads 1   # on the others: an item is the work of one core
#    python -m stages.compose parallel=dask
#    DASK_SCHEDULER=tcp://HOST:8786 dvc repro
#
# Without ``DASK_SCHEDULER`` the run starts workers on its own machine, which is a way to try it.

address = os.environ.get("DASK_SCHEDULER")
client = Client(address) if address else Client(processes=False)
print(client.dashboard_link, sum(client.nthreads().values()), "cores")

# %%
# On Slurm
# --------
#
# dask-jobqueue submits the workers. The lines below keep the cluster until you press Enter. Run the pipeline in another
# shell, with the printed address as ``DASK_SCHEDULER``.

if shutil.which("sbatch"):
    from dask_jobqueue import SLURMCluster

    cluster = SLURMCluster(cores=16, processes=16, memory="64GB", walltime="04:00:00", queue="NAME")
    cluster.scale(jobs=10)
    input(f"{cluster.scheduler_address}, dashboard {cluster.dashboard_link}; Enter ends it ")

# %%
# Sweeps
# ------
#
# The jobs of a sweep are whole runs and share ``data/``. Hydra's launchers submit them:
#
# .. code-block:: sh
#
#    python -m stages.sweep -m hydra/launcher=submitit_slurm classifier=knn,svm
