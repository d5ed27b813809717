// Runs conformance vectors: `conformance FOLDER...`. Ends with 1 and a line for each failure where something differs.
#include <iostream>

#include "conformance.hpp"

int main(int count, char** words) {
    std::size_t failed = count < 2;
    if (count < 2) std::cout << "which folders? conformance FOLDER...\n";
    for (int n = 1; n < count; n++) {
        const metagraph::Verdict verdict = metagraph::conformance::run(words[n]);
        for (const std::string& failure : verdict.failures) std::cout << failure << "\n";
        std::cout << words[n] << ": " << verdict.passed << " of " << verdict.cases << " cases pass\n";
        failed += verdict.failures.size();
    }
    return failed > 0 ? 1 : 0;
}
