# The twin with its kernels compiled, run by a user without rights: docker build -t mill-twin .
# Programs are mounted:  docker run --rm -v "$PWD:/work" mill-twin check programs
FROM python:3.12-slim AS build
WORKDIR /source
COPY . .
RUN python -m venv /opt/twin \
    && PIP_CONSTRAINT=/source/constraints.txt /opt/twin/bin/pip install --no-cache-dir .

FROM python:3.12-slim
# Off-screen pictures.
RUN apt-get update \
    && apt-get install -y --no-install-recommends libegl1 libegl-mesa0 libgl1-mesa-dri \
    && rm -rf /var/lib/apt/lists/*
COPY --from=build /opt/twin /opt/twin
ENV PATH=/opt/twin/bin:$PATH MUJOCO_GL=egl
RUN useradd --uid 1000 --create-home twin
USER 1000
WORKDIR /work
ENTRYPOINT ["twin"]
CMD ["--help"]
