# SPDX-License-Identifier: Apache-2.0
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY COMMAND_ECHO STDOUT)
endfunction()

file(REMOVE_RECURSE ${FOLDER})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${FOLDER}/prefix)
set(flags "")
if(SANITIZE)
  set(flags -fsanitize=${SANITIZE})
endif()
foreach(project outside runs_model touch_alone)
  run(${CMAKE_COMMAND} -S ${PROJECTS}/${project} -B ${FOLDER}/${project} -G Ninja -DCMAKE_PREFIX_PATH=${FOLDER}/prefix
      -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${flags} -DEXAMPLES=${EXAMPLES})
  run(${CMAKE_COMMAND} --build ${FOLDER}/${project})
endforeach()
run(${FOLDER}/outside/outside)
run(${FOLDER}/outside/serve_array sim:contacts?rate=100 ${MODEL} 1)
run(${FOLDER}/prefix/bin/dermis --version)
