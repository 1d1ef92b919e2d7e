# Both commands and the studio on any machine with Docker:
#   docker build -t haptic-glance .
#   docker run --rm -v "$PWD/reports:/haptic-glance/reports" haptic-glance make repro
#   docker run --rm haptic-glance make test
#   docker run --rm -it --network host -v "$PWD/scans:/scans" haptic-glance haptic-glance studio /scans
# The studio answers the loopback address alone, hence --network host. Torch from the package index comes with CUDA; name
# an index with its CPU builds by --build-arg PIP_EXTRA_INDEX_URL=... for an image of a third of the size.
FROM python:3.11-slim
RUN apt-get update \
 && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends chromium git libatomic1 libegl1 libgl1-mesa-dri \
    libopengl0 make nodejs npm \
 && rm -rf /var/lib/apt/lists/*
ARG PIP_EXTRA_INDEX_URL
WORKDIR /haptic-glance
COPY . .
RUN PIP_NO_CACHE_DIR=1 make .venv/ready
ENV PATH=/haptic-glance/.venv/bin:$PATH
CMD ["make", "help"]
