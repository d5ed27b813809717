#pragma once

#include "CoreMinimal.h"
#include "Factories/Factory.h"
#include "MetagraphFactory.generated.h"

/** Imports an export's JSON, with the GLB beside it, as a Metagraph asset. */
UCLASS()
class METAGRAPHEDITOR_API UMetagraphFactory : public UFactory
{
	GENERATED_BODY()

public:
	UMetagraphFactory();

	/** Only JSON that Metagraph wrote; other JSON is left to other factories. */
	virtual bool FactoryCanImport(const FString& Filename) override;

	virtual UObject* FactoryCreateFile(
		UClass* InClass, UObject* InParent, FName InName, EObjectFlags Flags, const FString& Filename, const TCHAR* Parms,
		FFeedbackContext* Warn, bool& bOutOperationCanceled) override;
};
